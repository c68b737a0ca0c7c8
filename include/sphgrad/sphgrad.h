/* sphgrad: corrected SPH derivatives, first and second order (KGC, MLS, RKPM; classic ones).
 * SPDX-License-Identifier: MIT
 * "Eq. (n)" = Westhofen, Jeske, Bender 2023, doi:10.1145/3606933
 *
 * Five nouns carry the whole interface:
 *   view       your memory: where numbers stand, how far apart, of which type
 *   scheme     which derivative: dimension, method, kernel, support radius, threshold
 *   neighbors  who sums over whom, and where everyone stood (a copy of the positions)
 *   request    which results of which fields; nothing else is computed, stored or read
 *   context    threads, memory, instruction set, last message
 * and one verb, sphg_evaluate(). The other operators are short ways to call it.
 *
 * Notation  i target, j source, x_ij = x_i - x_j, r = |x_ij|, H support radius, V volume,
 *           d dimension, G_ij = grad Phi_j(x_i) shape-function gradient, C_i correction matrix.
 *           j is a neighbour of i when r < H and j is not i itself.
 * Units     [L] length, [a] unit of the field; any consistent system.
 * Structs   zero-initialise ({0}, in C++ {}), then set what you need: zero is the default or, where there
 *           is none, refused. They only grow at the end; the context knows the header you compiled
 *           against. Functions without a context read 1.0's members only.
 * Memory    views are borrowed for the call, lists until the next build (sphg_neighbors_use_lists); the
 *           library owns contexts and neighbours only. Inputs are never written. An output must not
 *           overlap an input or another output (ERROR_ARGUMENT). Once warm, no call allocates while
 *           counts, pairs included, stay within the largest seen, wherever the particles are by then.
 * Threads   one call at a time per context, any number of contexts at once; what a call takes as const
 *           may be shared by concurrent calls. Same input, same bits: for any number of threads, any
 *           executor, any split into subsets, on all instruction sets with fused multiply-add (x86-64-v3,
 *           v4, AArch64). Children of fork() may use contexts old and new: on the calling thread alone,
 *           or parallel_for, once OpenMP's threads have worked in the parent. If the parent ran OpenMP by
 *           other means, set threads = 1 in the child.
 * Range     f32: H from about 1e-12 to 1e12 in 3D (1e-18 to 1e18 in 2D), so that H^d and H^2 stay normal
 *           numbers; f64 far beyond. The entries of a correction table, and `square` results (unit 1 /
 *           L^2), must be representable as well. Finite input gives NaN or Inf only where A_j - A_i, a
 *           sum, or a ratio of volumes or densities leaves the type (f32: about 1e38).
 * Rank      isolated, collinear, coplanar and coincident particles are ordinary input: never an error,
 *           never NaN; each target's `rank` tells how much could be corrected. */
#ifndef SPHGRAD_SPHGRAD_H
#define SPHGRAD_SPHGRAD_H
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define SPHG_VERSION_MAJOR 0 /* CMakeLists.txt reads the version from these three lines */
#define SPHG_VERSION_MINOR 1
#define SPHG_VERSION_PATCH 0
#define SPHG_VERSION       (SPHG_VERSION_MAJOR * 10000 + SPHG_VERSION_MINOR * 100 + SPHG_VERSION_PATCH)

#ifndef SPHG_API /* the build of a static library hides its functions: SPHG_EXPORT_STATIC */
#if defined(_WIN32) && defined(SPHG_SHARED_BUILD)
#define SPHG_API __declspec(dllexport)
#elif defined(_WIN32) && defined(SPHG_SHARED)
#define SPHG_API __declspec(dllimport)
#elif defined(__GNUC__)
#define SPHG_API __attribute__((visibility("default")))
#else
#define SPHG_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Results ---------------------------------------------------------------------------- */

/* Positive: refused, nothing was written. Negative: begun, the outputs of this call are
 * undefined. Context and neighbours can be used again after both. */
#define SPHG_RESULT_LIST(X)                                                                        \
    X(OK, 0, "success")                                                                            \
    X(ERROR_ARGUMENT, 1, "null pointer, negative count, or a value out of range")                  \
    X(ERROR_VERSION, 2, "compiled against a header this library cannot serve")                     \
    X(ERROR_TYPE, 3, "a view does not have the precision of the neighbours")                       \
    X(ERROR_SIZE, 4, "counts, dimensions, radii or targets of neighbours and request disagree")            \
    X(ERROR_STATE, 5, "the neighbours were never built, or their last build failed")               \
    X(ERROR_UNSUPPORTED, 6, "not on this machine, or no such operator for this shape")             \
    X(ERROR_CAPACITY, 7, "an output array is too small; the size needed was reported")             \
    X(ERROR_NOT_FINITE, 8, "a position is NaN or infinite")                                        \
    X(ERROR_BUSY, 9, "the context is in use by another call")                                      \
    X(ERROR_LISTS, 10, "neighbour lists lack pairs or name them twice")                            \
    X(ERROR_MEMORY, -1, "the allocator returned NULL")                                             \
    X(ERROR_INDEX, -2, "a neighbour index is out of range")                                        \
    X(ERROR_VOLUME, -3, "a volume is negative or not finite")
#define SPHG_X(name, value, text) SPHG_##name = value,
typedef enum sphg_result { SPHG_RESULT_LIST(SPHG_X) } sphg_result;
#undef SPHG_X

SPHG_API const char *sphg_result_string(sphg_result result); /* static storage, never NULL */
SPHG_API int32_t sphg_version(void);                         /* SPHG_VERSION of the library */

/* ---- Views: your memory ----------------------------------------------------------------- */

typedef enum sphg_type { SPHG_F32 = 1, SPHG_F64 = 2, SPHG_U8 = 3 } sphg_type;

/* What one item holds, and in which order its numbers stand. */
typedef enum sphg_shape {
    SPHG_SCALAR = 1,     /* 1 number */
    SPHG_VECTOR = 2,     /* d: x y z */
    SPHG_SYM_TENSOR = 3, /* d (d + 1) / 2: xx xy xz yy yz zz, in 2D xx xy yy */
    SPHG_TENSOR = 4      /* d x d, row-major: J[a][b] = d v_a / d x_b (Eigen: RowMajor) */
} sphg_shape;

/* Other orders, for hosts whose matrices are whole ones of a library. */
typedef enum sphg_layout {
    SPHG_AS_SHAPE = 0,
    SPHG_COLUMN_MAJOR = 1, /* TENSOR column by column: Eigen's default, Fortran's j(a, b) */
    SPHG_FULL = 2          /* SYM_TENSOR, and C_i of linearised methods of order 1, as all d x d
                              numbers: outputs are written twice, of inputs xx xy xz yy yz zz is read */
} sphg_layout;

/* Strided view. Item k starts at (char *)x + k * stride; its numbers follow one another. Only if
 * y (and z) are set, the second (third) component of a vector, or row (column) of a tensor, starts there:
 * separate arrays, or 2 x 2 results in 3 x 3 storage. z is not used in 2D.
 * stride 0, inputs but positions only: one item for all (uniform volume, constant field). x NULL:
 * absent. */
typedef struct sphg_view {
    const void *x, *y, *z; /* an output is written through them all the same */
    ptrdiff_t stride;      /* [byte], multiple of the number's size; may be negative */
    sphg_type type;
    sphg_layout layout; /* 0: as the shape says */
} sphg_view;

static inline sphg_view sphg_view_f32(const float *first, ptrdiff_t stride)
{
    sphg_view view = {first, NULL, NULL, stride, SPHG_F32, SPHG_AS_SHAPE};
    return view;
}
static inline sphg_view sphg_view_f64(const double *first, ptrdiff_t stride)
{
    sphg_view view = {first, NULL, NULL, stride, SPHG_F64, SPHG_AS_SHAPE};
    return view;
}
static inline sphg_view sphg_view_u8(const uint8_t *first, ptrdiff_t stride)
{
    sphg_view view = {first, NULL, NULL, stride, SPHG_U8, SPHG_AS_SHAPE};
    return view;
}
static inline sphg_view sphg_xyz_f32(const float *x, const float *y, const float *z, ptrdiff_t stride)
{
    sphg_view view = {x, y, z, stride, SPHG_F32, SPHG_AS_SHAPE};
    return view;
}
static inline sphg_view sphg_xyz_f64(const double *x, const double *y, const double *z, ptrdiff_t stride)
{
    sphg_view view = {x, y, z, stride, SPHG_F64, SPHG_AS_SHAPE};
    return view;
}
static inline sphg_view sphg_same_f32(const float *first) /* one item for all */
{
    return sphg_view_f32(first, 0);
}
static inline sphg_view sphg_same_f64(const double *first)
{
    return sphg_view_f64(first, 0);
}
static inline sphg_view sphg_absent(void)
{
    sphg_view view = {NULL, NULL, NULL, 0, SPHG_F32, SPHG_AS_SHAPE};
    return view;
}

/* ---- Context: who works, and with whose memory ------------------------------------------ */

typedef struct sphg_context sphg_context;

typedef enum sphg_isa {
    SPHG_ISA_BEST = 0, /* of this machine */
    SPHG_ISA_BASE = 1,
    SPHG_ISA_X86_V3 = 2,
    SPHG_ISA_X86_V4 = 3,
    SPHG_ISA_NEON = 4 /* on AArch64 the base */
} sphg_isa;

/* Works on the items [begin, end). worker is in [0, threads); no two tasks have it at once. */
typedef void sphg_task(void *data, int32_t begin, int32_t end, int32_t worker);

typedef struct sphg_config {
    int32_t threads; /* 0: as many as OpenMP has; 1: the calling thread alone, no OpenMP region;
                        with parallel_for: the number of its workers */
    sphg_isa isa;    /* BEST, or for tests; BASE: same bits on every x86-64 machine; X86_V3, X86_V4
                        and NEON: the same bits as one another */
    int32_t trusted; /* 1: do not look for bad numbers in positions, volumes and lists, nor compare
                        the targets of source sets; arguments are always checked */
    void *(*allocate)(size_t size, size_t alignment, void *user); /* both or neither */
    void (*release)(void *memory, size_t size, void *user);
    void (*log)(sphg_result result, const char *message, void *user); /* hears each failure */
    /* Calls task on disjoint ranges that make up [0, count), each >= grain long where it can, and
     * returns when all are done; grain >= 1. Order and split are free: results do not depend on them. */
    void (*parallel_for)(sphg_task *task, void *data, int32_t count, int32_t grain, void *user);
    void *user; /* handed back to these four */
} sphg_config;

/* version: SPHG_VERSION. config: copied; NULL: defaults. A host with its own tasks makes one
 * context per worker, threads = 1. Errors (*context is NULL then): ARGUMENT, VERSION,
 * UNSUPPORTED, MEMORY. */
SPHG_API sphg_result sphg_context_create(int32_t version, const sphg_config *config,
                                         sphg_context **context);
SPHG_API void sphg_context_destroy(sphg_context *context); /* NULL is ignored */

typedef struct sphg_context_info {
    int32_t threads; /* that a call takes at most; 1 in a child of fork() without OpenMP's */
    sphg_isa isa;    /* in use, never BEST; NEON where the base has it */
    int32_t openmp;  /* 1: compiled in; 0: parallel_for or the calling thread */
    int64_t bytes;   /* held by the context beside its neighbours */
} sphg_context_info;

/* Errors: ARGUMENT, BUSY. Cost: O(1). */
SPHG_API sphg_result sphg_context_get_info(sphg_context *context, sphg_context_info *info);

/* Why the last failed call on this context failed: function, argument, value. Never NULL; valid
 * until the next call. */
SPHG_API const char *sphg_last_message(const sphg_context *context);

/* ---- Scheme: which derivative ----------------------------------------------------------- */

/* G_ij = C_i s_ij x_ij, C_i from M_i = -sum_j s_ij x_ij x_ij^T. Other names: KGC is called
 * renormalisation, B matrix, CSPM gradient; linearised RKPM IAD; linearised MLS the GIZMO or SWIFT
 * gradient. */
typedef enum sphg_method {
    SPHG_KGC = 0,   /* s_ij = V_j W'/r    Eq. (17, 18) */
    SPHG_MLS = 1,   /* s_ij = -W          Eq. (24, 25) */
    SPHG_RKPM = 2,  /* s_ij = -V_j W      Eq. (30, 31) */
    SPHG_CMLS = 3,  /* classic: full derivative of the interpolant with weight W */
    SPHG_CRKPM = 4, /* the same with weight V_j W */
    SPHG_PLAIN = 5  /* SPH: KGC with C_i = 1    Eq. (14) */
} sphg_method;

typedef enum sphg_kernel {
    SPHG_CUBIC_SPLINE = 0,
    SPHG_QUINTIC_SPLINE = 1,
    SPHG_WENDLAND_C2 = 2,
    SPHG_WENDLAND_C4 = 3,
    SPHG_WENDLAND_C6 = 4,
    SPHG_POLY6 = 5,
    SPHG_SPIKY = 6
} sphg_kernel;

/* What becomes of a direction whose normalised moment lambda (1 in a full neighbourhood) is
 * small. A direction counts in `rank` when it is fully corrected. */
typedef enum sphg_policy {
    SPHG_BLEND = 0,    /* w/lambda + (1 - w), w = smoothstep(eps, 4 eps); full from 4 eps on */
    SPHG_REPLACE = 1,  /* 1/lambda if lambda > eps, else 1: the paper's rule, discontinuous */
    SPHG_TRUNCATE = 2, /* 1/lambda if lambda > eps, else 0: pseudo-inverse */
    SPHG_IDENTITY = 3  /* the particle stays uncorrected as soon as one lambda <= eps */
} sphg_policy;

typedef struct sphg_scheme {
    int32_t dimension; /* 2 or 3; 0: 3 */
    sphg_method method;
    sphg_kernel kernel;
    sphg_policy policy;
    double support_radius; /* H [L] > 0 */
    double threshold;      /* eps in (0, 1); 0: 1e-2. Needs absolute volumes, but for classic
                              methods: lambda grows with them; 100 times too small, in a wrong
                              unit, they give rank 0 everywhere and no error */
    int32_t order; /* 0, 1: exact on linear fields; 2 (KGC, MLS, RKPM; not DIRECT): on quadratic
                      ones where `rank` is d (d + 3) / 2. Inside a fluid H = 2 spacings suffice, at
                      surfaces 2.5 to 3, or 2 with `lenders`; else curvature that neighbours do not
                      resolve counts as 0, down to what order 1 gives. Its threshold is a tenth of
                      eps. Momentum wants order 1: the ADJOINT of order 2 pushes a free surface 2 to
                      5 times harder under constant stress */
} sphg_scheme;

/* Numbers per item of a correction table: linearised d (d + 1) / 2, C_i as SYM_TENSOR; classic
 * (d + 1)^2, the interpolant's coefficients and their derivatives; PLAIN 0. Order 2: 15 in 2D, 45 in
 * 3D, of the inverse [P Q; Q^T R] of -sum s_ij p p^T, p = (x, x x^T / 2 as xx/2 xy xz yy/2 ..) with
 * x = -x_ij: P and R as upper triangles, Q row by row between them; G_ij = -s_ij [P Q] p. */
SPHG_API int32_t sphg_correction_width(const sphg_scheme *scheme);

/* W(r) [L^-d] and W'(r)/r [L^-(d + 2)], finite for r >= 0 (spiky: W'/r is unbounded towards 0 and
 * given as 0 at r = 0), 0 for r >= H. Either may be NULL. Reads dimension, kernel and
 * support_radius; a scheme that is not valid gives NaN. */
SPHG_API void sphg_kernel_value(const sphg_scheme *scheme, double r, double *w, double *dw_over_r);

/* W(r) = sigma w(r/H) / H^d with w as tabulated in docs/theory.md: sigma, and the second moment
 * mu2 = (1/H^2) int W x_k^2 dV. Either may be NULL. A scheme that is not valid gives NaN. */
SPHG_API void sphg_kernel_constants(const sphg_scheme *scheme, double *sigma, double *mu2);

/* ---- Neighbours: who sums over whom ----------------------------------------------------- */

/* One set of targets, one set of sources, and a copy of their positions: operators use those of
 * the last successful build, wherever your particles are by now. So a rest configuration is a
 * sphg_neighbors that you build once. Several source sets: one object each (few sets; join many
 * small bodies into one). */
typedef struct sphg_neighbors sphg_neighbors;

typedef struct sphg_geometry {
    sphg_view sources;    /* x_j [L], source_count vectors */
    sphg_view targets;    /* x_i [L], target_count vectors. Absent: the targets are the sources'
                             first target_count particles, "part of" this source set; or targets_of */
    int32_t source_count; /* ghosts included; 0: sources.x may be NULL, as all views of the set */
    int32_t target_count;
    sphg_type precision; /* of all fields and results; 0: as the positions. F32 beside F64
                            positions: differences are taken before narrowing. Never wider */
    int32_t list_free;   /* search without a skin; 1: keep no pairs: less memory, less time if used once */
    int32_t keep_weights; /* search only; 1: room for the weight that a scheme gives each pair: the first
                             sweep fills it, later ones of the same kernel, method and volumes read it and
                             save the kernel; same bits. 4 bytes a pair (f64: 8). Of use without skin and
                             periodic axes; classic methods form theirs anew */
    double skin;         /* [L], search only: find pairs up to H + skin and keep them until a
                            particle has moved skin / 2; results are exact throughout */
    double period[3];    /* [L] per axis; 0: open; else >= 2 (H + skin) up to rounding; positions anywhere:
                            of fl(fl(x_i - x_j) + k period) the smallest counts, where fmod(x, period)
                            stands for x if |x| is beyond a period and 2^16 H (f64: 2^45 H). Skins
                            measure moves to the nearest image */
    sphg_view source_support; /* H_j [L] > 0, of the positions' type; absent: all have the scheme's
                                 radius, which is not read otherwise. H above is then the largest;
                                 other skins are in proportion, growth of H counts as a move */
    sphg_view target_support; /* H_i of targets apart: there if the other is */
    int32_t mutual;           /* 1: j is a neighbour of i where r < max(H_i, H_j), as SYMMETRIC and ADJOINT
                                 need it; 0: where r < H_i. G_ij and units of i have H_i either way */
    const sphg_neighbors *targets_of; /* search only; instead of targets: the targets, with places and
                                         radii, are those of this object, searched before with the
                                         same period. Neither read nor sorted again if without skin
                                         and of the same H. Alive and not rebuilt as long as in use */
} sphg_geometry;

/* The usual ways; set precision, list_free, skin and period afterwards. */
static inline sphg_geometry sphg_targets_apart(sphg_view targets, int32_t target_count,
                                               sphg_view sources, int32_t source_count)
{
    sphg_geometry geometry;
    memset(&geometry, 0, sizeof geometry);
    geometry.sources = sources;
    geometry.targets = targets;
    geometry.source_count = source_count;
    geometry.target_count = target_count;
    return geometry;
}
static inline sphg_geometry sphg_all(sphg_view positions, int32_t count) /* over all */
{
    return sphg_targets_apart(sphg_absent(), count, positions, count);
}
static inline sphg_geometry sphg_targets_of(const sphg_neighbors *other, sphg_view sources,
                                            int32_t source_count)
{
    sphg_geometry geometry = sphg_targets_apart(sphg_absent(), 0, sources, source_count);
    geometry.targets_of = other;
    return geometry;
}
static inline sphg_geometry sphg_own_and_ghosts(sphg_view positions, int32_t own, int32_t ghosts)
{ /* the first `own` are targets; sources are these and the ghosts behind them */
    return sphg_targets_apart(sphg_absent(), own, positions, own + ghosts);
}

/* Your own lists: complete (each pair from both ends), any superset of the neighbours (of r < H, or
 * what `mutual` says), any order, no duplicates; i itself is skipped. Set one of the three groups.
 * Lists that lack pairs are summed as they are: sphg_neighbors_check finds them. DIFFERENCE and
 * classic DIRECT, with C of the same lists, stay exact on linear fields where rank = d, which fewer
 * targets reach. ADJOINT and SYMMETRIC keep what they conserve only if pairs lack at both ends:
 * half lists, and lists cut at a maximum, lose momentum. PLAIN and other DIRECT sums are short of
 * what is missing. */
typedef struct sphg_lists {
    const int64_t *offsets;     /* CSR: target_count + 1 items from 0, non-decreasing ... */
    const int32_t *indices;     /* ... and offsets[target_count] source indices */
    const int32_t *const *rows; /* or a pointer per target ... */
    const int32_t *lengths;     /* ... and its number of indices */
    /* or a function that returns the length; called by the workers, needs no locking per worker. Its
       array must live until that worker's next call; it is copied, so a sweep takes 15 % longer */
    int32_t (*row)(int32_t target, int32_t worker, const int32_t **indices, void *user);
    void *user;         /* handed to row */
    int32_t index_mask; /* bits of an index that count (LAMMPS: NEIGHMASK); 0: all */
    int32_t copy;       /* 1: copied by the build, then yours to change; same bits as borrowed ones,
                           at the speed of the library's own */
} sphg_lists;

typedef struct sphg_neighbors_info {
    int64_t pairs; /* listed, skin included; 0 if list_free, for rows and for functions */
    int64_t bytes; /* held by this object */
    int32_t target_count, source_count;
    int32_t rebuilt;  /* 1: the last search found pairs anew; 0: the skin still held */
    double skin_left; /* [L] any particle may move this far before the next rebuild */
} sphg_neighbors_info;

/* An empty object, NULL on failure; its memory is the context's: destroy it first. */
SPHG_API sphg_result sphg_neighbors_create(sphg_context *context, sphg_neighbors **neighbors);
SPHG_API void sphg_neighbors_destroy(sphg_neighbors *neighbors); /* NULL is ignored */

/* Copies the positions and finds all pairs with r < H, exactly those of brute force. Reads
 * dimension and support_radius of scheme. Call it every step; a skin that holds is kept.
 * Errors: ARGUMENT, TYPE, SIZE, NOT_FINITE, BUSY (old state kept); MEMORY (build again).
 * Cost: time and memory O(n + pairs) for any extent of the domain, wrapped by the host or not. Cells
 * of a periodic axis are wider by 2^-21 (f64: 2^-50) of the largest |x| that is left (see period):
 * it counts beside H only where the period is longer than about 10^5 H (f64: 10^13 H). */
SPHG_API sphg_result sphg_neighbors_search(sphg_context *context, sphg_neighbors *neighbors,
                                           const sphg_scheme *scheme,
                                           const sphg_geometry *geometry);
/* rebuild: 1 where that search would find pairs anew, 0 where the skin holds; nothing is built. MPI: ask
 * before ghosts move, and decide together. Errors: as there, the object stays. Cost: O(n). */
SPHG_API sphg_result sphg_neighbors_would_rebuild(sphg_context *context, const sphg_neighbors *neighbors,
                                                  const sphg_scheme *scheme,
                                                  const sphg_geometry *geometry, int32_t *rebuild);

/* Copies the positions and borrows your lists: leave them unchanged until the next build or
 * destroy. Pairs that are none add nothing. Indices are checked as operators read them.
 * With lists.copy they are checked and copied now, in about the time of a sweep, and take 4 bytes a
 * pair and some 50 a target. Each later sweep saves a tenth to a fifth of its time. row is asked
 * several times a target.
 * Errors: ARGUMENT, TYPE, SIZE, NOT_FINITE, BUSY (old state kept); MEMORY, with copy INDEX (build
 * again). Cost: O(n), with copy O(n + pairs). */
SPHG_API sphg_result sphg_neighbors_use_lists(sphg_context *context, sphg_neighbors *neighbors,
                                              const sphg_scheme *scheme, const sphg_geometry *geometry,
                                              const sphg_lists *lists);

/* What the object holds; counts are 0 before the first build. Errors: ARGUMENT, BUSY. Cost: O(1). */
SPHG_API sphg_result sphg_neighbors_get_info(sphg_context *context, const sphg_neighbors *neighbors,
                                             sphg_neighbors_info *info);

typedef enum sphg_fault {
    SPHG_FAULT_NONE = 0,
    SPHG_FAULT_LENGTH = 1,    /* negative, or without indices */
    SPHG_FAULT_INDEX = 2,     /* no source */
    SPHG_FAULT_DOUBLED = 3,   /* the list names a neighbour twice */
    SPHG_FAULT_ONE_SIDED = 4, /* it lacks a neighbour whose own list has the target */
    SPHG_FAULT_MISSING = 5    /* it lacks a neighbour, as the other end does */
} sphg_fault;

/* What is wrong with the lowest target whose list is, and how many others are. */
typedef struct sphg_list_fault {
    sphg_fault kind;
    int32_t target, source; /* -1: none */
    int32_t faulty;         /* targets with a fault, this one included */
    double distance;        /* [L] r of the pair; 0 for lengths and indices */
} sphg_list_fault;

/* For hosts under development: are all pairs with r < H there, once and from both ends? Searches the
 * positions of the last build again, with the scheme's H, and compares, lists of the library too. Further
 * pairs are no fault. fault may be NULL; the message says the same.
 * Errors: ARGUMENT, SIZE, STATE, BUSY; LISTS (fault written); MEMORY, INDEX (fault written, too).
 * Cost: some dozens of searches; memory as the pairs exported. */
SPHG_API sphg_result sphg_neighbors_check(sphg_context *context, const sphg_scheme *scheme,
                                          const sphg_neighbors *neighbors, sphg_list_fault *fault);

/* order[k]: the k-th source on the library's path through space, source_count items. Sort your particles
 * by it now and then: operators are fastest on data in this order.
 * Errors: ARGUMENT, STATE, BUSY; with lists of yours MEMORY. Cost: a copy; with lists a sort. */
SPHG_API sphg_result sphg_neighbors_get_order(sphg_context *context,
                                              const sphg_neighbors *neighbors, int32_t *order);

/* ---- Request: which results ------------------------------------------------------------- */

/* One source set, as the targets see it. */
typedef struct sphg_sources {
    const sphg_neighbors *neighbors;
    sphg_view volume;     /* V_j [L^d] >= 0, in the unit of the positions: sums of V_j fill space
                             (threshold); not read by CMLS in DIFFERENCE and DIRECT */
    sphg_view density;    /* rho_j; read in SYMMETRIC only */
    sphg_view correction; /* C_j; read in ADJOINT and SYMMETRIC, unless this set's A_j are 0 */
    int32_t same_volumes; /* 1: the V_j are those of the sweep before, so that weights that were kept
                             (keep_weights) may be read. One volume for all is compared, not asked */
} sphg_sources;

/* Some of the targets. Arrays stay indexed by target; what is not selected is not touched. */
typedef struct sphg_subset {
    int32_t begin, end;     /* targets [begin, end), or the items [begin, end) of indices */
    const int32_t *indices; /* NULL, or target indices without duplicates */
    const uint8_t *mask;    /* NULL, or target_count bytes: 0 leaves a target out */
} sphg_subset; /* indices or mask with end = 0: refused as forgotten, unless there are no targets; a
                  list that may be empty has indices = NULL then, as sphg_listed gives it */

static inline sphg_subset sphg_range(int32_t begin, int32_t end)
{
    sphg_subset subset = {begin, end, NULL, NULL};
    return subset;
}
static inline sphg_subset sphg_masked(const uint8_t *mask, int32_t target_count)
{
    sphg_subset subset = {0, target_count, NULL, mask};
    return subset;
}
static inline sphg_subset sphg_listed(const int32_t *indices, int32_t count) /* 0: nobody */
{
    sphg_subset subset = {0, count, count ? indices : NULL, NULL};
    return subset;
}

/* The summand over j. `A G` is A G (gradient), A . G (divergence) or G x A (curl). */
typedef enum sphg_form {
    SPHG_DIFFERENCE = 0, /* (A_j - A_i) G_ij    Eq. (15). Exact on linear fields where rank = d;
                            conserves nothing */
    SPHG_DIRECT = 1,     /* A_j G_ij    Eq. (13). A surface term, for normals and colour fields;
                            classic: self included, exact on linear fields where rank = d */
    SPHG_SYMMETRIC = 2,  /* rho_i m_j (A_i G_ij / (V_j rho_i^2) - A_j G_ji / (V_i rho_j^2))
                            Eq. (16). Inexact even on constants; conserves linear momentum */
    SPHG_ADJOINT = 3     /* V_i A_i G_ij - V_j A_j G_ji. A force; div A = result / V_i. The
                            negative adjoint of DIFFERENCE to rounding; conserves linear
                            momentum, angular where C is the exact inverse and A symmetric */
} sphg_form;

/* One field, and what is wanted of it. ADJOINT results have the unit [a L^(d - 1)]. */
typedef struct sphg_field {
    sphg_shape shape; /* of A */
    sphg_form form;
    int32_t accumulate;          /* 1: add to what the outputs hold */
    const sphg_view *at_sources; /* A_j [a], a view per source set. Absent view: A_j = A_i with
                                    `mirror`, else 0, and refused in DIFFERENCE */
    sphg_view at_targets;        /* A_i [a]; absent: from the set the targets are part of. DIRECT:
                                    read by `mirror` only, where that set has none */
    sphg_view value;             /* [a], shape as A. DIRECT: sum A_j Phi_j(x_i), self included.
                                    Classic: exact on linear fields; others: sum A_j V_j W.
                                    DIFFERENCE: the same of A_j - A_i, as XSPH and density diffusion */
    sphg_view gradient;          /* [a/L] scalar -> vector, vector -> tensor */
    sphg_view divergence;        /* [a/L] vector -> scalar, tensor or symmetric -> vector */
    sphg_view curl;              /* [a/L] vector -> vector, in 2D -> scalar */
    sphg_view square;            /* [a/L^2] DIRECT scalar only: sum A_j |G_ij|^2, for diagonals of
                                    pressure systems; classic: self included */
    int32_t mirror;              /* 1: sources of sets whose view is absent carry the value of the
                                    target that looks at them, as walls do pressure: A_j = A_i */
    sphg_view hessian;           /* [a/L^2] DIFFERENCE, order 2: scalar -> symmetric tensor, vector
                                    -> d of them, one for each component (y and z start those) */
    sphg_view laplacian;         /* [a/L^2] DIFFERENCE, order 2: its trace, shape as A. For diffusion
                                    in time only where no surface is free: unstable there.
                                    [a k L^(d - 2)] ADJOINT, order 1, not classic: heat, or momentum,
                                    that flows into i: sum k_ij L_ij (A_j - A_i) with
                                    L_ij = -(V_i G_ij - V_j G_ji) . x_ij / r^2 >= 0. Symmetric,
                                    conservative, nothing leaves through surfaces; result / V_i stands
                                    for div(k grad A): solutions converge, the values themselves do
                                    not. PLAIN: Brookshaw, Morris */
    sphg_view curvature; /* DIFFERENCE, order 2: what a target lends: c in [0, 1], how sure it is,
                            and c times the Hessian of each component; 1 + d (d + 1) / 2 numbers, of
                            a vector 1 + d times as many. Never accumulated */
    const sphg_view *lenders; /* DIFFERENCE, order 2, no tables: such numbers of an earlier call, a
                                 view per source set (absent: it lends nothing); NULL: nobody lends.
                                 Curvature that a target cannot resolve is then its lenders', not 0.
                                 MPI: between the calls refresh the ghosts' rows */
    const sphg_view *coefficient; /* k_j [k] >= 0 of ADJOINT laplacian, a view per source set; NULL: 1.
                                     k_ij = 2 k_i k_j / (k_i + k_j), 0 where either is */
    sphg_view coefficient_at_targets; /* k_i; absent: from the set the targets are part of */
    int32_t shepard;               /* 1: DIRECT value divided by sum V_j W, self included: exact on
                                      constants at surfaces, too (0 where nobody is). Not classic */
    const sphg_view *value_volume; /* V_j of value alone, a view per source set; NULL: the sets'. Not
                                      classic */
    sphg_view tensor;      /* T_i [t], TENSOR, at the targets: with contraction */
    sphg_view contraction; /* [a t/L] vector -> scalar: sum J[a][b] T[a][b], J the gradient of the
                              field's form */
} sphg_field;

/* Counts over those targets of one call whose corrections were computed. */
typedef struct sphg_stats {
    int64_t rank[4];    /* targets of rank 0, 1, 2, 3; order 2: of the directions up to d */
    int64_t certified;  /* inverted on the fast path, proven untouched by the threshold */
    int64_t decomposed; /* sent to the eigensolver */
    int64_t empty;      /* of these: nothing to sum (classic: sum w = 0, value and gradient 0) */
    double lambda_min;  /* the smallest; +inf if there were no targets */
    int64_t quadratic;  /* order 2: targets exact on quadratic fields */
} sphg_stats;

typedef struct sphg_request {
    const sphg_sources *sources; /* their sums add up, moments included. All have the same targets
                                    in the same places and order: compared unless `trusted` */
    const sphg_field *fields;
    int32_t set_count;   /* sources, 1 to 4096 */
    int32_t field_count; /* 0 to 4096; 0: fields is NULL */
    const sphg_subset *subset; /* NULL: all targets */

    /* Values at the targets. Absent: taken from the source set that the targets are part of. */
    sphg_view target_volume;     /* V_i; read by MLS (scale of M; absent on both sides: the mean
                                    sum V_j W / sum W), DIRECT `value`, ADJOINT, SYMMETRIC */
    sphg_view target_density;    /* rho_i; read in SYMMETRIC only */
    sphg_view target_correction; /* C_i; none on either side: computed in the same sweep */

    /* Outputs about corrections that this call computes: not allowed beside a table. */
    sphg_view correction; /* C_i, sphg_correction_width() numbers an item */
    sphg_view rank;       /* U8: fully corrected directions, 0..d; order 2: d and more where linear
                             fields are exact, with the directions of curvature that are resolved */
    sphg_view lambda_min; /* smallest normalised moment, >= 0: exact where decomposed, elsewhere a
                             lower bound, at most a factor sqrt(d) too small */
    sphg_stats *stats;
    sphg_view borrows; /* U8, order 2: 1 where lenders could change results: the mask of a call that
                          has them */
} sphg_request;

/* All that the request names, at least one result, in one sweep over the pairs. Views have the
 * neighbours' precision.
 * scheme: dimension as in the build, support_radius at most that of the search.
 * MPI: ask for `correction` of your own n of n + ghosts particles; refresh the ghosts' rows; then
 * ADJOINT or SYMMETRIC with that table as sources' correction. DIFFERENCE needs no exchange.
 * Errors: ARGUMENT, TYPE, SIZE, STATE, UNSUPPORTED, BUSY; MEMORY, INDEX, VOLUME.
 * Cost: grows with the selected targets and the wanted results. */
SPHG_API sphg_result sphg_evaluate(sphg_context *context, const sphg_scheme *scheme,
                                   const sphg_request *request);

/* ---- Short ways, for targets that are part of their only source set ----------------------
 * Requests of one source set and at most one field: errors, cost, precision and aliasing as at
 * sphg_evaluate(). */

/* C_i into correction; rank: U8, or absent. Needs no sources->correction, reads none. */
SPHG_API sphg_result sphg_correction(sphg_context *context, const sphg_scheme *scheme,
                                     const sphg_sources *sources, const sphg_subset *subset,
                                     sphg_view correction, sphg_view rank);

/* DIFFERENCE form. sources->correction absent: C_i computed on the way. Field and result must be
 * there.
 *   gradient    scalar field [a] -> vector [a/L]
 *   jacobian    vector field     -> tensor J[a][b] = d v_a / d x_b
 *   divergence  vector field     -> scalar
 *   curl        vector field     -> vector, in 2D scalar */
SPHG_API sphg_result sphg_gradient(sphg_context *context, const sphg_scheme *scheme,
                                   const sphg_sources *sources, const sphg_subset *subset,
                                   sphg_view field, sphg_view gradient);
SPHG_API sphg_result sphg_jacobian(sphg_context *context, const sphg_scheme *scheme,
                                   const sphg_sources *sources, const sphg_subset *subset,
                                   sphg_view field, sphg_view jacobian);
SPHG_API sphg_result sphg_divergence(sphg_context *context, const sphg_scheme *scheme,
                                     const sphg_sources *sources, const sphg_subset *subset,
                                     sphg_view field, sphg_view divergence);
SPHG_API sphg_result sphg_curl(sphg_context *context, const sphg_scheme *scheme,
                               const sphg_sources *sources, const sphg_subset *subset,
                               sphg_view field, sphg_view curl);

/* ADJOINT form: f_i = sum V_i S_i G_ij - V_j S_j G_ji, a vector. shape of S: scalar (for S times
 * the unit matrix), symmetric or full tensor. sources->correction must be there (not for PLAIN). */
SPHG_API sphg_result sphg_force(sphg_context *context, const sphg_scheme *scheme,
                                const sphg_sources *sources, const sphg_subset *subset,
                                sphg_shape shape, sphg_view stress, sphg_view force);

/* ---- Pairs, for loops of your own -------------------------------------------------------- */

/* Your arrays; what is NULL or absent is not wanted. */
typedef struct sphg_pairs {
    int64_t *offsets;   /* selected targets + 1 items, from 0 */
    int32_t *indices;   /* j, ascending within a row, unless any_order */
    sphg_view gradient; /* G_ij [1/L], a vector per pair */
    int64_t capacity;   /* pairs that indices and gradient can hold */
    int64_t count;      /* out: pairs there are; with `block` places */
    int32_t any_order;  /* 1: rows keep the order that the library sums in, the same each time */
    int32_t block;      /* 4, 8, 16: rows begin at multiples of it, filled up with the last j and G_ij = 0;
                           `gradient`, without gaps, has so many x, then y, then z. 0: pair after pair */
    int32_t *lengths;   /* pairs of each row, less what fills it up */
} sphg_pairs;

/* The selected targets' pairs with r < H as CSR, with their G_ij if wanted: all of them (one call with
 * offsets alone for the count, then the rest), or so few targets at a time that they stay in the cache.
 * C_i: target_correction, else sources->correction if the targets are part of that set, else computed;
 * volume and C are read for `gradient` only. Classic methods: a target that is part of the sources stands
 * among its own pairs, since G_ii is not 0.
 * Errors: as sphg_evaluate; CAPACITY: nothing written but count. */
SPHG_API sphg_result sphg_pair_gradients(sphg_context *context, const sphg_scheme *scheme,
                                         const sphg_sources *sources, const sphg_subset *subset,
                                         sphg_view target_correction, sphg_pairs *pairs);

/* G_ij of one pair; support_radius is H_i. correction: item i of the table; NULL: PLAIN. gradient: d numbers. */
SPHG_API void sphg_pair_gradient(const sphg_scheme *scheme, const double *x_ij, double volume,
                                 const double *correction, double *gradient);

#ifdef __cplusplus
}
#endif

#include "small_matrices.h" /* inverses of moments, eigenvalues, SVD, in batches */
#endif
