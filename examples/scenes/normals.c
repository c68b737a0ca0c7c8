/* SPDX-License-Identifier: MIT */
/* Boundary normals on an irregularly sampled wall (the paper's Fig. 3). Queries above a plane,
 * above a plane with fluid on it, and above a sphere ask for sum G_ik over the wall's particles. */
#include "solver/output.h"
#include "solver/sampling.h"
#include "solver/wall.h"
#include <math.h>
#include <stdlib.h>

static const double radius = 0.02;         /* of a particle, r [m] */
static const double support_radius = 0.08; /* 4 r */
static const double wall_distance = 1.7;   /* least, between wall particles [r] */
static const double sphere_radius = 12;    /* [r] */
static const double degrees = 57.29577951308232;

enum {
    FEWEST_WALL = 4, /* fewer do not tell where the wall is */
    FLUID_SIDE = 50,
    FLUID_LAYERS = 5,
    PICTURE_SIDE = 24
};

/* Sums of the angles between normals found and true normals. */
struct angles {
    int32_t count;
    double sum, largest;
};

static double angle_between(const double *a, const double *b)
{
    vector normal;
    cross(a, b, normal);
    return degrees * atan2(sqrt(dot(normal, normal)), dot(a, b));
}

static void angles_add(struct angles *angles, const double *slope, const double *outward)
{
    const vector found = {-slope[0], -slope[1], -slope[2]};
    const double angle = angle_between(found, outward);
    ++angles->count;
    angles->sum += angle;
    angles->largest = fmax(angles->largest, angle);
}

static struct wall plane(const struct sph *sph, struct random *random, double half)
{
    const double low[2] = {-half, -half}, high[2] = {half, half};
    vector *x;
    const int32_t count = sample_rectangle(random, low, high, wall_distance * radius, &x);
    return wall_new(sph, count, x);
}

static struct particles queries(int32_t count)
{
    struct particles made = particles_new(count, 0.8 * pow(2 * radius, 3));
    for (int32_t i = 0; i < count; ++i)
        particles_set_rest_density(&made, i, 1000);
    return made;
}

/* As in a step of a simulation: what was found at other heights must not stay. */
static void update_from_elsewhere(const struct sph *sph, struct contact *contact,
                                  struct particles *points)
{
    for (int step = 0; step < 2; ++step) {
        for (int32_t i = 0; i < points->count; ++i)
            points->x[i][2] *= step ? 2 : 0.5;
        contact_update(sph, contact, points);
    }
}

/* On a plane the corrected slope is more than a direction: its length is 1 / distance. */
static void measure_plane(const struct run *run, const struct sph *sph, struct random *random)
{
    struct wall wall = plane(sph, random, 0.6);
    struct particles points = queries(run->options->full ? 100000 : 4000);
    struct contact contact = contact_new(sph, &wall, points.count);
    struct angles angles = {0};
    double worst_distance = 0;
    for (int32_t i = 0; i < points.count; ++i) {
        points.x[i][0] = random_between(random, -0.45, 0.45);
        points.x[i][1] = random_between(random, -0.45, 0.45);
        points.x[i][2] = random_between(random, 0.25, 0.85) * support_radius;
    }
    update_from_elsewhere(sph, &contact, &points);
    for (int32_t i = 0; i < points.count; ++i) {
        const vector up = {0, 0, 1};
        const double length = sqrt(dot(contact.slope[i], contact.slope[i]));
        if (contact.touching[i] < FEWEST_WALL)
            continue;
        angles_add(&angles, contact.slope[i], up);
        worst_distance = fmax(worst_distance, fabs(length * points.x[i][2] - 1));
    }
    metrics_set(run->metrics, "queries", angles.count);
    metrics_set(run->metrics, "plane_mean_degrees", angles.sum / angles.count);
    metrics_set(run->metrics, "plane_max_degrees", angles.largest);
    metrics_set(run->metrics, "distance_error", worst_distance);
    contact_free(&contact);
    particles_free(&points);
    wall_free(&wall);
}

static void measure_sphere(const struct run *run, const struct sph *sph, struct random *random)
{
    vector *x;
    const int32_t count = sample_sphere(random, sphere_radius * radius, wall_distance * radius, &x);
    struct wall wall = wall_new(sph, count, x);
    struct particles points = queries(4000);
    struct contact contact = contact_new(sph, &wall, points.count);
    struct angles angles = {0};
    for (int32_t i = 0; i < points.count; ++i) {
        const double height = random_between(random, -1, 1), across = sqrt(1 - height * height);
        const double angle = random_between(random, 0, 360 / degrees);
        const double far =
            sphere_radius * radius + random_between(random, 0.25, 0.85) * support_radius;
        points.x[i][0] = far * across * cos(angle);
        points.x[i][1] = far * across * sin(angle);
        points.x[i][2] = far * height;
    }
    contact_update(sph, &contact, &points);
    for (int32_t i = 0; i < points.count; ++i)
        if (contact.touching[i] >= FEWEST_WALL)
            angles_add(&angles, contact.slope[i], points.x[i]);
    metrics_set(run->metrics, "sphere_mean_degrees", angles.sum / angles.count);
    metrics_set(run->metrics, "sphere_max_degrees", angles.largest);
    contact_free(&contact);
    particles_free(&points);
    wall_free(&wall);
}

/* Slopes of the wall where fluid and wall share one matrix: the wall's field is 1, the fluid has
 * none. */
static void shared_matrix_slopes(const struct sph *sph, const struct contact *contact,
                                 const struct particles *fluid, vector *slopes)
{
    const double one = 1;
    const sphg_view fields_of_sets[2] = {sphg_absent(), everywhere(&one)};
    sphg_neighbors *neighbors = sph_neighbors(sph);
    sph_search(sph, neighbors, fluid->count, fluid->x);
    const sphg_sources sets[2] = {
        {.neighbors = neighbors, .volume = everywhere(&fluid->rest_volume)},
        {.neighbors = contact->neighbors, .volume = scalars(contact->wall->volume)}};
    sphg_field field = direct_field(SPHG_SCALAR, fields_of_sets);
    field.gradient = vectors(slopes);
    const sphg_request request = {.sources = sets,
                                  .set_count = 2,
                                  .fields = &field,
                                  .field_count = 1,
                                  .target_volume = everywhere(&fluid->rest_volume)};
    sph_check(sph, sphg_evaluate(sph->context, &sph->corrected, &request));
    sphg_neighbors_destroy(neighbors);
}

static struct particles fluid_layers(struct random *random)
{
    struct particles fluid = queries(FLUID_SIDE * FLUID_SIDE * FLUID_LAYERS);
    for (int32_t i = 0; i < fluid.count; ++i) {
        const int32_t place[3] = {i % FLUID_SIDE, i / FLUID_SIDE % FLUID_SIDE,
                                  i / FLUID_SIDE / FLUID_SIDE};
        for (int k = 0; k < 3; ++k) {
            const double middle = k == 2 ? -0.5 : 0.5 * (FLUID_SIDE - 1);
            fluid.x[i][k] =
                2 * radius * (place[k] - middle) + radius * random_between(random, 0, 0.3);
        }
    }
    return fluid;
}

static bool is_counted(const struct contact *contact, const struct particles *fluid, int32_t i)
{
    return contact->touching[i] >= FEWEST_WALL && fabs(fluid->x[i][0]) < 0.4 &&
           fabs(fluid->x[i][1]) < 0.4;
}

/* The paper takes the wall into the fluid's matrix, which spoils the normals; a matrix of the wall
 * alone does not. */
static void measure_beside_fluid(const struct run *run, const struct sph *sph,
                                 struct random *random)
{
    const vector up = {0, 0, 1};
    struct wall wall = plane(sph, random, 0.6);
    struct particles fluid = fluid_layers(random);
    struct contact contact = contact_new(sph, &wall, fluid.count);
    vector *slopes = array_new(fluid.count, sizeof *slopes);
    struct angles alone = {0}, shared = {0};
    contact_update(sph, &contact, &fluid);
    shared_matrix_slopes(sph, &contact, &fluid, slopes);
    for (int32_t i = 0; i < fluid.count; ++i)
        if (is_counted(&contact, &fluid, i)) {
            angles_add(&alone, contact.slope[i], up);
            angles_add(&shared, slopes[i], up);
        }
    metrics_set(run->metrics, "beside_fluid_max_degrees", alone.largest);
    metrics_set(run->metrics, "shared_matrix_max_degrees", shared.largest);
    free(slopes);
    contact_free(&contact);
    particles_free(&fluid);
    wall_free(&wall);
}

/* The row of the raster that is drawn, from the side: what the normal has along x, and its angle.
 */
static void write_row(const struct run *run, const struct wall *wall,
                      const struct particles *points, const struct contact *contact)
{
    FILE *sampled = output_open(run, "wall"), *found = output_open(run, "normals");
    const int32_t begin = PICTURE_SIDE / 2 * PICTURE_SIDE;
    for (int32_t k = 0; sampled && k < wall->count; ++k)
        if (fabs(wall->x[k][1] - points->x[begin][1]) < 0.5 * support_radius)
            fprintf(sampled, "%g\n", wall->x[k][0]);
    for (int32_t i = begin; found && i < begin + PICTURE_SIDE; ++i) {
        const double *slope = contact->slope[i];
        const vector up = {0, 0, 1}, normal = {-slope[0], -slope[1], -slope[2]};
        fprintf(found, "%g %g %g\n", points->x[i][0], normal[0] / normal[2],
                angle_between(normal, up));
    }
    output_close(sampled);
    output_close(found);
}

/* Normals above a raster of places on a plane. */
static void write_tables(const struct run *run, const struct sph *sph, struct random *random)
{
    struct wall wall = plane(sph, random, 0.45);
    struct particles points = queries(PICTURE_SIDE * PICTURE_SIDE);
    struct contact contact = contact_new(sph, &wall, points.count);
    for (int32_t i = 0; i < points.count; ++i) {
        points.x[i][0] = 0.6 * ((i % PICTURE_SIDE + 0.5) / PICTURE_SIDE - 0.5);
        points.x[i][1] = 0.6 * ((i / PICTURE_SIDE + 0.5) / PICTURE_SIDE - 0.5);
        points.x[i][2] = 0.5 * support_radius;
    }
    contact_update(sph, &contact, &points);
    write_row(run, &wall, &points, &contact);
    const struct output_field fields[] = {{"slope", contact.slope[0], 3}, {NULL, NULL, 0}};
    output_particles(run, 0, 0, points.count, points.x, fields);
    contact_free(&contact);
    particles_free(&points);
    wall_free(&wall);
}

static void simulate(const struct run *run)
{
    struct random random = {run->options->seed};
    struct sph sph = run_open(run, 3, support_radius, 4000);
    measure_plane(run, &sph, &random);
    measure_beside_fluid(run, &sph, &random);
    measure_sphere(run, &sph, &random);
    if (run->options->output)
        write_tables(run, &sph, &random);
    sph_close(&sph);
}

/* Arrows of one length, whose tilt is drawn three times as large. */
static void draw(const struct picture *picture)
{
    FILE *script = picture->script;
    picture_begin(picture, 1100, 460);
    fprintf(script, "set xrange [-0.31:0.31]\nset yrange [-0.005:0.11]\nset cbrange [0:15]\n"
                    "set palette defined (0 '#0072b2', 6 '#cc79a7', 15 '#d55e00')\n"
                    "set border 0\nunset ytics\nset xtics 0.1 nomirror out\n"
                    "angle(tilt) = atan(3 * tilt)\n");
    picture_bar(picture, 0.92, "angle to the true normal [degrees]");
    for (int k = 0; k < 2; ++k) {
        picture_panel(picture, 0.02, 0.9);
        fprintf(
            script,
            "set bmargin at screen %g\nset tmargin at screen %g\n%s"
            "set title \"{/:Bold %s}: off by up to %.*g degrees above a flat wall of irregular "
            "particles; tilt drawn three times\"\n"
            "plot 'normals_%s_wall.dat' using 1:(0) with points pt 7 ps 1.1 lc rgb '#999999', "
            "'normals_%s_normals.dat' using 1:(0.04):(0.05*sin(angle($2))):(0.05*cos(angle($2))):3 "
            "with vectors filled head size screen 0.012,20 lw 3 lc palette\n",
            0.6 - 0.45 * k, 0.9 - 0.45 * k,
            k ? "set xtics 0.1 format '%g'\nset xlabel 'x [m]'\n" : "set xtics 0.1 format ''\n",
            picture->titles[k], 2, metrics_get(picture->metrics[k], "plane_max_degrees"),
            picture->methods[k], picture->methods[k]);
    }
}

int main(int argc, char **argv)
{
    static const struct gate gates[] = {{"plane_max_degrees", ONLY_SPH, AT_LEAST, 5},
                                        {"plane_max_degrees", EACH_CORRECTED, AT_MOST, 1e-6},
                                        {"distance_error", EACH_CORRECTED, AT_MOST, 1e-9},
                                        {"beside_fluid_max_degrees", EACH_CORRECTED, AT_MOST, 1e-6},
                                        {"shared_matrix_max_degrees", EACH_CORRECTED, AT_LEAST, 5},
                                        {"sphere_mean_degrees", EACH_CORRECTED, AT_LEAST, 0.5},
                                        {"sphere_mean_degrees", EACH_CORRECTED, SHARE_OF_SPH, 0.5},
                                        {0}};
    static const struct scene scene = {
        "normals", "Boundary normals above irregular walls.", simulate, draw, gates, true, false};
    return scene_main(&scene, argc, argv);
}
