/* SPDX-License-Identifier: MIT */
/* The passes: arithmetic on validated memory, compiled once per scalar type and instruction set and
 * chosen at run time through a table of functions. They keep no state, allocate nothing and cannot
 * fail. Lengths inside are in units of H, volumes in units of H^d (docs/theory.md, section 2).
 * What is handed to them stands in search.h and sums.h. */
#ifndef SPHGI_PASSES_H
#define SPHGI_PASSES_H
#include "columns.h"
#include "search.h"
#include "sums.h"

struct sphgi_passes {
    int32_t lanes;

    /* Rows. order NULL: item k itself. */
    void (*load_rows)(const struct sphgi_columns *columns, const int32_t *order, int64_t begin,
                      int64_t end, int32_t first, int32_t count, void *rows);
    /* Rows x y z 0 of positions [begin, end); false: one is not finite. */
    bool (*read_positions)(const struct sphgi_columns *columns, int64_t begin, int64_t end,
                           void *rows);
    /* Coordinates of rows beyond the limit become their remainder by the period, which is exact and
     * has their sign. largest[a] is raised to the largest |coordinate| there is then. */
    void (*take_into_box)(const struct sphgi_periods *periods, int64_t count, void *rows,
                          double *largest);
    /* Block, and cell in it, of each row; false: one is too far away, and all are undefined. */
    bool (*cut)(const struct sphgi_cutting *cutting, const void *rows, int32_t count,
                int32_t (*block)[4], uint8_t *local);
    /* The same for rows with radii: block and octave, and quarter of one of its cells. */
    bool (*cut_octaves)(const struct sphgi_cutting *cutting, const void *rows, int32_t count,
                        int32_t (*block)[4], uint8_t *local);
    /* x y z from load_rows' columns; the first item that is not finite, or -1. */
    int64_t (*first_not_finite)(const struct sphgi_columns *columns, int64_t begin, int64_t end);
    /* Rows [begin, begin + count) of positions with the volumes, times factor, written into the 4th
     * number. [0]: volumes are f32, [1]: f64. False: a volume is negative or not finite. */
    bool (*put_volumes[2])(const void *positions, const struct sphgi_columns *volume, double factor,
                           const int32_t *order, int64_t begin, int64_t count, void *rows);
    double (*largest_move)(const struct sphgi_periods *periods, const void *then, const void *now,
                           int64_t begin, int64_t end);

    /* Lays the coordinates of runs side by side in find->staged, and says where each begins. */
    void (*stage)(const struct sphgi_find *find, struct sphgi_runs *runs);
    /* Search for up to SPHGI_FIND_MOST targets, whose rows follow one another, in runs that are
     * staged. self: row of the first, if it is a source of the first run, those of the others
     * follow; else -1. Each list is in the order of the runs, and SPHGI_FIND_PAD dummies follow;
     * there is room for all candidates and SPHGI_FIND_SLACK more. */
    void (*find)(const struct sphgi_find *find, const struct sphgi_runs *runs, const void *targets,
                 int32_t count, int32_t self, uint32_t *const *lists, int32_t *lengths);

    /* The least and the largest of each of the four numbers of rows. */
    void (*bounds)(const void *rows, int32_t count, double *low, double *high);

    /* The same for targets, and sources, with radii of their own, the 4th numbers of rows: first
     * the candidates of as many targets as there may be are packed. Runs stand in any order; self
     * may be in any of them. Then the lists of some of these are found, of which `self` is the
     * first one's number among the packed, or -1. */
    void (*pack_by_radii)(const struct sphgi_find *find, const struct sphgi_runs *runs,
                          const void *targets, int32_t count, int32_t self,
                          struct sphgi_packed *packed);
    void (*find_by_radii)(const struct sphgi_find *find, const struct sphgi_packed *packed,
                          const void *targets, int32_t count, int32_t self, uint32_t *const *lists,
                          int32_t *lengths);

    /* Of `count` ids of a list, those within reach of the target's row stay: they move together, or
     * if `pack` is not set, the dummy takes the place of the others. Padded to SPHGI_LANES_MOST
     * with the dummy, for which there is room. Returns how many there are now. */
    int32_t (*keep_near)(const struct sphgi_find *find, const void *target, uint32_t *ids,
                         int32_t count, bool pack);

    /* Pairs behind tile->ids into the arrays; targets: row number of each lane's; lanes: of the
     * tile. [0]: f32 arrays, [1]: f64. Masked: what is no pair gets the dummy's id. */
    void (*gather[2])(const struct sphgi_gather *gather, const int32_t *targets, int32_t lanes,
                      struct sphgi_tile *tile);
    /* The same with the factors s_ij instead of the distances, on open axes. Rows of the type of
     * the arrays. */
    void (*gather_factors)(const struct sphgi_gather *gather, const struct sphgi_shape *shape,
                           const int32_t *targets, struct sphgi_tile *tile);
    /* The same of pairs that need no test, with offsets in units of H. */
    void (*gather_quadratic)(const struct sphgi_gather *gather, const struct sphgi_shape *shape,
                             const int32_t *targets, struct sphgi_tile *tile);

    /* The same where rows hold the radii of sources: s_ij without V_j into SPHGI_S, and w or w' / q
     * with the source's radius into SPHGI_D; and of pairs that gather() has put into the tile, with
     * H_j in the place of V_j. */
    void (*gather_both)(const struct sphgi_gather *gather, const struct sphgi_shape *shape,
                        const int32_t *targets, struct sphgi_tile *tile);
    void (*weigh_both)(const struct sphgi_shape *shape, const struct sphgi_tile *tile);

    /* Factors that stand in memory, [step][SPHGI_GROUP] from that of the first lane
     * on; and what puts them there. */
    void (*gather_offsets)(const struct sphgi_gather *gather, const void *kept,
                           const int32_t *targets, struct sphgi_tile *tile);
    void (*keep_factors)(const struct sphgi_tile *tile, void *kept);

    /* Ids to sums of a vector of targets at once, of pairs that need no test. The tile lends its
     * arrays. */
    void (*sum_group)(const struct sphgi_group_sums *group, const struct sphgi_shape *shape,
                      const struct sphgi_group_lists *lists, struct sphgi_tile *tile);
    /* The same for the classic methods as far as it can come at once: a chunk of the lists, from
     * ids to the tile's offsets and weights, V_j in both if `weighted`, and to the moments unless
     * sums is NULL. */
    void (*begin_classic)(const struct sphgi_gather *gather, const struct sphgi_shape *shape,
                          const int32_t *targets, bool weighted, struct sphgi_tile *tile,
                          void *sums);
    /* The same for order 2. */
    void (*sum_quadratic_group)(const struct sphgi_group_sums *group,
                                const struct sphgi_shape *shape,
                                const struct sphgi_group_lists *lists, struct sphgi_tile *tile);

    /* The same over records; NULL: there is no such pass. These are made of rows x y z . of `count`
     * sources, of which `axes` numbers stand in records, and what columns have of them, in order;
     * columns NULL: without it. width: as sphgi_record_width says; past: the caches. */
    void (*sum_records)(const struct sphgi_record_sums *sums, const struct sphgi_shape *shape,
                        const struct sphgi_group_lists *lists, struct sphgi_tile *tile);
    void (*put_records)(const void *rows, const struct sphgi_columns *columns, const int32_t *order,
                        int64_t count, int32_t axes, int32_t width, bool past, void *records);

    /* SPHGI_GROUP lists side by side: [step][list]. Each is padded to four with the dummy or, if
     * that is not 0, has `padded` dummies behind it; then up to sixteen steps more are written. */
    void (*weave)(const uint32_t *const *lists, const int32_t *count, int32_t steps, int32_t padded,
                  uint32_t dummy, uint32_t *to);
    /* Of lists that stand side by side those with a bit in `active`, one beside the other from
     * `lane` on. */
    void (*pick_lists)(const uint32_t *ids, uint32_t active, int32_t steps, int32_t lane,
                       uint32_t *to);
    /* Steps [begin, begin + tile->steps) of the lists become the ids of the tile. Lists with a
     * stride of 1 are padded to a multiple of four with the dummy. */
    void (*interleave)(const struct sphgi_lane_lists *lists, int32_t begin, uint32_t dummy,
                       struct sphgi_tile *tile);

    /* A list of the host's becomes ids, padded to SPHGI_PAD. True: it holds what is no source. */
    bool (*clean_ids)(const int32_t *list, int32_t count, const struct sphgi_cleaning *how,
                      uint32_t *out);
    /* The same for steps [begin, begin + tile->steps) of lists of the host's, which become the ids
     * of the tile. */
    bool (*interleave_hosts)(const struct sphgi_lane_lists *lists, int32_t begin,
                             const struct sphgi_slots *slots, struct sphgi_tile *tile);

    /* H^d of the plan over that of each target, 1 / H, 1 / H^2, and the factor of s_ij. */
    void (*lane_units)(int32_t width, const struct sphgi_lane_units *units, const double *radius,
                       void *ratio, void *inverse, void *inverse_square, void *factor);

    /* Factors of tables as sphgi_share has them (plan/units.h): mantissa and two powers of two. */
    void (*lane_table_units)(int32_t width, const double *factor, void *mantissa, void *first,
                             void *second);

    /* Arrays from `first` on, times a number per lane. */
    void (*scale_pairs)(const struct sphgi_tile *tile, enum sphgi_array first, int32_t count,
                        const void *each);

    /* Weights. */
    void (*shape_factors)(const struct sphgi_shape *shape, void *arrays, int32_t count);
    /* The factors with the radius of j, whose rows hold H over it. */
    void (*shape_other)(const struct sphgi_shape *shape, const struct sphgi_tile *tile,
                        const void *rows);
    void (*shape_weights)(const struct sphgi_shape *shape, void *arrays, int32_t count);
    void (*shape_values)(void *arrays, int32_t count);
    /* What order 2 sums over, where sum_quadratic_moments has not left it. */
    void (*shape_products)(const struct sphgi_tile *tile, int32_t dimension);
    /* W of shape_weights where factors leave it alone; and V_j W of it, V_j in rows, times unit and
     * a number per lane, or 1. */
    void (*keep_kernel)(void *arrays, int32_t count);
    void (*values_of_volumes)(const struct sphgi_tile *tile, const void *rows, double unit,
                              const void *each);
    void (*classic_vectors)(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                            const void *coefficients);
    /* G_ij = scale times what order 2 has. */
    void (*quadratic_gradients)(const struct sphgi_tile *tile, int32_t dimension,
                                const void *correction, double scale);
    /* G_ij = scale C_i times the vectors; correction NULL: scale alone. */
    void (*pair_gradients)(const struct sphgi_tile *tile, int32_t dimension,
                           enum sphgi_vectors vectors, const void *correction, double scale);
    void (*transposed)(const struct sphgi_tile *tile, int32_t dimension, const void *const rows[4],
                       const void *density, enum sphgi_weight kind);
    /* L_ij from the direction e of each pair: -s_ij e^T (E_i + unit weight_j C_j) e, E_i of the
     * targets and rows of C_j, of which either may be NULL; and -s_ij factor each for C = 1.
     * Written, or added to what stands there. */
    void (*pair_laplacian)(const struct sphgi_tile *tile, int32_t dimension, const void *own,
                           const void *const *table, double inverse_h, double unit,
                           enum sphgi_weight kind, bool add);
    void (*pair_laplacian_plain)(const struct sphgi_tile *tile, double factor, const void *each,
                                 bool add);
    void (*transposed_classic)(const struct sphgi_tile *tile, int32_t dimension,
                               const void *const rows[4], const struct sphgi_scales *scales,
                               const void *target_volume, const void *density,
                               enum sphgi_weight kind);

    /* The same where sources have radii of their own. */
    void (*transposed_classic_other)(const struct sphgi_shape *shape, const struct sphgi_tile *tile,
                                     const struct sphgi_other_side *of);
    /* Rows times a number each, and before that, unless it is NULL, times another. */
    void (*scale_rows)(int32_t count, const void *first, const void *second, void *rows);

    /* rows: P and Q of the sources; between: what Q is multiplied with to have the unit of P. */
    void (*transposed_quadratic)(const struct sphgi_tile *tile, int32_t dimension,
                                 const void *const *rows, double between, const void *density,
                                 enum sphgi_weight kind);
    /* The same where sources have radii of their own. */
    void (*transposed_quadratic_other)(const struct sphgi_shape *shape,
                                       const struct sphgi_tile *tile,
                                       const struct sphgi_other_side *of);

    /* Sums: [sum][SPHGI_WIDTH]. */
    void (*sum_moments)(const struct sphgi_tile *tile, int32_t dimension, void *sums);
    void (*sum_classic)(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                        void *sums);
    /* What follows once y is known; solution: as solve_classic leaves it. */
    void (*sum_classic_slopes)(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                               const void *solution, void *sums);
    /* Moments of second, third and fourth order; offsets in units of H, as for the classic ones. */
    void (*sum_quadratic_moments)(const struct sphgi_tile *tile, int32_t dimension, void *sums);
    /* What sum_field gives over s_ij x_ij, and the same over products of the offsets. */
    void (*sum_quadratic_field)(const struct sphgi_tile *tile, int32_t dimension, const void *rows,
                                int32_t count, const void *at_target, void *sums, void *second);
    /* sum s x and sum -s x x, or with densities in the first number of the rows */
    void (*sum_quadratic_vectors)(const struct sphgi_tile *tile, int32_t dimension,
                                  const void *rows, void *sums);
    /* Rows times the weight -s_ij. */
    void (*sum_lent)(const struct sphgi_tile *tile, const void *rows, int32_t count, void *sums);
    void (*sum_field)(const struct sphgi_tile *tile, int32_t dimension, enum sphgi_vectors vectors,
                      const void *rows, int32_t count, const void *at_target, void *sums);
    /* The same over classic G_ij, in one loop with what forms them. */
    void (*sum_classic_field)(const struct sphgi_tile *tile, int32_t dimension, bool weighted,
                              const void *coefficients, const void *rows, int32_t count,
                              const void *at_target, void *sums);
    /* The same, contracted: (A_j - A_i) . g, of tensors row by row. rows: of each stream */
    void (*sum_divergence)(const struct sphgi_tile *tile, int32_t dimension, sphg_shape shape,
                           enum sphgi_vectors vectors, const void *const *rows,
                           const void *at_target, void *sums);
    /* sum (A_j - at_target) g g^T: one sum for its trace, d (d + 1) / 2 for its triangle */
    void (*sum_squares)(const struct sphgi_tile *tile, int32_t dimension,
                        enum sphgi_vectors vectors, int32_t count, const void *rows,
                        const void *at_target, void *sums);
    void (*sum_value)(const struct sphgi_tile *tile, const void *rows, int32_t count,
                      const void *at_target, void *sums);
    void (*sum_weights)(const struct sphgi_tile *tile, void *sums); /* of values */
    void (*means)(int32_t width, int32_t count, const void *weights, void *values);
    /* sum k_ij L_ij (A_j - at_target), k_ij the harmonic mean of both ends' coefficients, or 1 */
    void (*sum_diffusion)(const struct sphgi_tile *tile, const void *rows, int32_t count,
                          const void *coefficients, const void *own_coefficient,
                          const void *at_target, void *sums);
    void (*sum_vectors)(const struct sphgi_tile *tile, int32_t dimension,
                        enum sphgi_vectors vectors, const void *rows, void *sums);
    /* sum s_ij b_j x_ij; and, unless vectors is NULL, sum s_ij x_ij or, where a number o_j stands
     * behind b_j, sum o_j s_ij x_ij. factors: SPHGI_S, or SPHGI_D of gather_both for what stands
     * before b_j. rows: of each 4 numbers */
    void (*sum_folded)(const struct sphgi_tile *tile, int32_t dimension, enum sphgi_fold fold,
                       bool dense, enum sphgi_array factors, const void *const *rows, void *sums,
                       void *vectors);
    void (*sum_volume)(const struct sphgi_tile *tile, void *sums);
    /* What the chunks of a spread tile come to, added to the first lane's sums; chunks: there are.
     */
    void (*join_lanes)(const struct sphgi_tile *tile, int32_t chunks, int32_t count, void *sums);
    /* Adds the carries, once a list is through. */
    void (*settle)(const struct sphgi_tile *tile, int32_t count, void *sums);

    /* From here on `width` says for how many targets, a multiple of lanes.
     * Corrections: sums in, numbers of the table out. scale: what turns a target's sums into
     * normalised moments (MLS: V_i / H^d), NULL: 1; the correction takes the same factor.
     * lambda_min NULL: not wanted. invert() leaves the lanes in verdict->decomposed to
     * decompose(), whose results for a lane do not depend on the others. */
    void (*invert)(int32_t width, const struct sphgi_threshold *threshold, const void *moments,
                   const void *scale, void *correction, void *lambda_min,
                   struct sphgi_verdict *verdict);
    void (*decompose)(int32_t width, const struct sphgi_threshold *threshold, const void *moments,
                      const void *scale, void *correction, void *lambda_min,
                      struct sphgi_verdict *verdict);
    /* Classic corrections: sums of sum_classic in, what is known before the slopes out (S0 y, C,
     * the mean of xi, 1 / S0: no more numbers than a correction has); and this with the sums of
     * sum_classic_slopes becomes the correction, in its place. */
    void (*solve_classic)(int32_t width, const struct sphgi_threshold *threshold, double mu2,
                          const void *sums, const void *self, void *solution, void *lambda_min,
                          struct sphgi_verdict *verdict);
    void (*finish_classic)(int32_t width, int32_t dimension, const void *sums, void *coefficients);
    /* The linear correction, where `coefficients` begin, becomes the whole one. kept: as decompose
     * leaves it, elsewhere 1. directions: of curvature that are resolved, all of them where
     * quadratic fields are exact; written for `lanes`. borrowing NULL: without all that. */
    void (*invert_quadratic)(int32_t width, int32_t dimension, const struct sphgi_second *second,
                             const void *sums, const void *scale, const void *kept, int32_t lanes,
                             const struct sphgi_borrowing *borrowing, void *coefficients,
                             uint8_t *directions);
    /* A = Q diag(values) Q^T of one group of matrices, values descending, det Q = 1. */
    void (*eigen)(int32_t width, int32_t dimension, const void *matrices, void *values,
                  void *vectors);

    /* Results. each: a factor per target, or NULL. */
    void (*apply)(int32_t width, int32_t dimension, int32_t count, const void *correction,
                  const void *sums, double scale, const void *each, void *jacobian);
    /* Gradients, times scale; Hessians and their traces, times its square, unless hessian is NULL:
     * [component][pair][target]. */
    void (*apply_quadratic)(int32_t width, int32_t dimension, int32_t count,
                            const void *coefficients, const void *sums, const void *second,
                            double scale, void *jacobian, void *hessian, void *laplacian);
    /* What apply_quadratic gave for its own shift becomes what lenders make of it. */
    void (*add_borrowed)(int32_t width, int32_t dimension, int32_t count,
                         const struct sphgi_second *second, const struct sphgi_borrowing *borrowing,
                         double scale, void *jacobian, void *hessian, void *laplacian);
    /* c and, times c, `count` numbers of Hessians. */
    void (*lend)(int32_t width, int32_t count, const void *confidence, const void *hessian,
                 void *out);
    void (*scale)(int32_t width, int32_t count, const void *in, double factor, const void *each,
                  void *out);
    void (*divide)(int32_t width, int32_t count, const void *in, double divisor, void *out);
    bool (*valid_volumes)(int32_t width, const void *volumes); /* >= 0 and finite in every lane */
    void (*fill)(int32_t count, double value, void *out);      /* a multiple of lanes */
    /* a NULL: 1; 0 where b is 0 */
    void (*source_weights)(int32_t width, enum sphgi_weight kind, const void *volume,
                           const void *density, void *weights);
    void (*quotient)(int32_t width, const void *a, const void *b, void *out);
    void (*add_outer)(int32_t width, int32_t dimension, int32_t count, const void *a, const void *b,
                      const void *each, void *jacobian);
    /* The adjoint or the symmetric form, as a gradient or a divergence: own_gradient is G_i, sums
     * those over the sources' terms. */
    void (*two_sided_gradient)(int32_t width, int32_t dimension, int32_t count,
                               const struct sphgi_two_sided *of, const void *a,
                               const void *own_gradient, const void *sums, void *gradient);
    void (*two_sided_divergence)(int32_t width, int32_t dimension, sphg_shape shape,
                                 const struct sphgi_two_sided *of, const void *a,
                                 const void *own_gradient, const void *sums, void *divergence);
    void (*square)(int32_t width, int32_t dimension, const struct sphgi_square *of,
                   const void *sums, void *square);
    void (*double_product)(int32_t width, int32_t count, const void *a, const void *b, void *out);
    void (*contract)(int32_t width, int32_t dimension, sphg_shape shape, const void *jacobian,
                     void *divergence, void *curl);
    /* Asks the memory for what load_lanes or store_lanes will touch. */
    void (*ask_for_lanes)(int32_t width, const struct sphgi_columns *columns, const int32_t *items,
                          bool write);
    /* Lanes with a bit in `kept` stay, one after the other, of `count` numbers of as many lanes as
     * a vector has. */
    void (*pack_lanes)(uint32_t kept, int32_t count, void *numbers);
    void (*load_lanes)(int32_t width, const struct sphgi_columns *columns, const int32_t *items,
                       void *out);
    void (*store_lanes)(int32_t targets, const struct sphgi_columns *columns, const int32_t *items,
                        const void *in, bool accumulate);
    /* Sums of several source sets: rows of `stride` numbers an item, which hold something where the
     * item has a mark. Lanes whose numbers are all 0 are not put away, so that nothing depends on
     * whether anybody looked. */
    void (*put_away)(int32_t targets, int32_t count, const void *lanes, const int32_t *items,
                     void *rows, int32_t stride, uint8_t *marks);
    /* Adds them to the lanes of their items. */
    void (*add_put_away)(int32_t targets, int32_t count, const void *rows, int32_t stride,
                         const int32_t *items, const uint8_t *marks, void *lanes);
};

extern const struct sphgi_passes sphgi_passes_f32_base, sphgi_passes_f64_base;
#ifdef SPHG_HAVE_V3
extern const struct sphgi_passes sphgi_passes_f32_v3, sphgi_passes_f64_v3;
#endif
#ifdef SPHG_HAVE_V4
extern const struct sphgi_passes sphgi_passes_f32_v4, sphgi_passes_f64_v4;
#endif

#endif
