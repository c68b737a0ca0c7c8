/* SPDX-License-Identifier: MIT */
/* Lists and subsets. */
#include "check.h"
#include "refuse.h"

static sphg_result check_offsets(struct sphgi_checker checker, const int64_t *offsets,
                                 int32_t target_count)
{
    if (offsets[0] != 0)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.offsets[0] is %lld, must be 0", checker.function,
               (long long)offsets[0]);
    for (int32_t i = 0; i < target_count; ++i)
        if (offsets[i + 1] < offsets[i])
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.offsets[%d] is %lld, less than the one before",
                   checker.function, (int)i + 1, (long long)offsets[i + 1]);
    return SPHG_OK;
}

sphg_result sphgi_check_lists(struct sphgi_checker checker, const sphg_lists *lists,
                              int32_t target_count)
{
    const char *f = checker.function;
    const sphg_result missing = sphgi_check_pointer(checker, lists, "lists");
    if (missing)
        return missing;
    const int csr = lists->offsets || lists->indices, rows = lists->rows || lists->lengths;
    if (!target_count && !lists->offsets && !lists->row) /* rows of nobody */
        return SPHG_OK;
    if (csr + rows + !!lists->row != 1)
        REFUSE(SPHG_ERROR_ARGUMENT,
               "%s: lists needs exactly one of offsets + indices, rows + lengths, row", f);
    if (csr) {
        if (!lists->offsets || (!lists->indices && lists->offsets[target_count] > 0))
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.%s is NULL", f,
                   lists->offsets ? "indices" : "offsets");
        if (!checker.context->config.trusted)
            return check_offsets(checker, lists->offsets, target_count);
    }
    if (rows && (!lists->rows || !lists->lengths))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: lists.%s is NULL", f, lists->rows ? "lengths" : "rows");
    return SPHG_OK;
}

sphg_result sphgi_refuse_list(struct sphgi_checker checker, int32_t target, int64_t index)
{
    if (index == SPHGI_BAD_LENGTH)
        REFUSE(SPHG_ERROR_INDEX, "%s: the list of target %d has a negative length or is NULL",
               checker.function, (int)target);
    REFUSE(SPHG_ERROR_INDEX, "%s: the list of target %d holds %lld, which is no source",
           checker.function, (int)target, (long long)index);
}

sphg_result sphgi_check_subset(struct sphgi_checker checker, const sphg_subset *subset,
                               int32_t target_count)
{
    const char *f = checker.function;
    if (!subset)
        return SPHG_OK;
    if (subset->begin < 0 || subset->end < subset->begin ||
        (!subset->indices && subset->end > target_count))
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: subset is [%d, %d) of %d targets", f, (int)subset->begin,
               (int)subset->end, (int)target_count);
    if ((subset->indices || subset->mask) && !subset->end && target_count > 0)
        REFUSE(SPHG_ERROR_ARGUMENT,
               subset->indices ? "%s: subset.indices is set, but subset.end is 0; if nobody is "
                                 "meant, indices is NULL, as sphg_listed(indices, 0) makes it"
                               : "%s: subset.mask is set, but subset.end is 0; "
                                 "sphg_masked(mask, target_count) sets both",
               f);
    for (int32_t k = subset->begin; subset->indices && k < subset->end; ++k)
        if (subset->indices[k] < 0 || subset->indices[k] >= target_count)
            REFUSE(SPHG_ERROR_ARGUMENT, "%s: subset.indices[%d] is %d of %d targets", f, (int)k,
                   (int)subset->indices[k], (int)target_count);
    return SPHG_OK;
}
