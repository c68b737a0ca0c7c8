/* SPDX-License-Identifier: MIT */
#include "check_targets.h"
#include "core/refuse.h"

static sphg_result check_object(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                                const sphg_neighbors *other, bool searched)
{
    const char *f = checker.function;
    if (!searched)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.targets_of is set, it is for searches only", f);
    if (other == neighbors)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.targets_of is the object that is to be built", f);
    if (other->kind != SPHGI_SEARCHED)
        REFUSE(SPHG_ERROR_STATE, "%s: geometry.targets_of holds no search", f);
    if (!sphgi_has_its_targets(other))
        REFUSE(SPHG_ERROR_STATE,
               "%s: geometry.targets_of has targets of an object that was built anew since", f);
    return SPHG_OK;
}

static sphg_result check_fit(struct sphgi_checker checker, const sphg_geometry *geometry,
                             const struct sphgi_scheme *scheme)
{
    const char *f = checker.function;
    const sphg_neighbors *other = geometry->targets_of;
    if (geometry->targets.x || geometry->target_support.x)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.%s and targets_of are both set", f,
               geometry->targets.x ? "targets" : "target_support");
    if (geometry->target_count && geometry->target_count != other->target_count)
        REFUSE(SPHG_ERROR_SIZE, "%s: geometry.target_count is %d, but targets_of has %d", f,
               (int)geometry->target_count, (int)other->target_count);
    if (scheme->dimension != other->dimension)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: scheme.dimension is %d, but %d in geometry.targets_of", f,
               (int)scheme->dimension, (int)other->dimension);
    if (geometry->sources.x && geometry->sources.type != other->position_type)
        REFUSE(SPHG_ERROR_TYPE,
               "%s: geometry.sources.type is %d, but positions of targets_of are %d", f,
               (int)geometry->sources.type, (int)other->position_type);
    for (int32_t a = 0; a < scheme->dimension; ++a)
        if (geometry->period[a] != other->period[a])
            REFUSE(SPHG_ERROR_ARGUMENT,
                   "%s: geometry.period[%d] is another one than that of targets_of", f, (int)a);
    if (geometry->source_count > 0 && !geometry->source_support.x == other->radii)
        REFUSE(SPHG_ERROR_ARGUMENT, "%s: geometry.source_support is %s, but targets_of has %s", f,
               other->radii ? "absent" : "set", other->radii ? "radii" : "none");
    return SPHG_OK;
}

sphg_result sphgi_check_targets_of(struct sphgi_checker checker, const sphg_neighbors *neighbors,
                                   const struct sphgi_scheme *scheme, bool searched,
                                   const sphg_geometry *geometry)
{
    const sphg_result result = check_object(checker, neighbors, geometry->targets_of, searched);
    return result ? result : check_fit(checker, geometry, scheme);
}
