/* The CSV files of the command `fields`. */
#include "fields.h"
#include "report/plot.h"

#include <stdio.h>
#include <stdlib.h>

const sphg_method fields_order[FIELDS_METHODS] = {SPHG_PLAIN, SPHG_KGC,  SPHG_MLS,
                                                  SPHG_RKPM,  SPHG_CMLS, SPHG_CRKPM};

static void write_header(FILE *file)
{
    fprintf(file, "x,y,vx,vy");
    for (int k = 0; k < FIELDS_METHODS; k++)
        fprintf(file, ",gradient_error_%s", method_names[fields_order[k]]);
    for (int k = 0; k < FIELDS_METHODS; k++)
        fprintf(file, ",curl_error_%s", method_names[fields_order[k]]);
    fprintf(file, "\n");
}

static void write_row(FILE *file, const struct study *study, enum study_field field, int32_t i,
                      const double *errors)
{
    double velocity[2];
    study_velocity(study, field, i, velocity);
    fprintf(file, "%.9g,%.9g,%.9g,%.9g", numbers_get(&study->positions, i, 0),
            numbers_get(&study->positions, i, 1), velocity[0], velocity[1]);
    for (int k = 0; k < 2 * FIELDS_METHODS; k++)
        fprintf(file, ",%.4e", errors[(ptrdiff_t)k * study->count + i]);
    fprintf(file, "\n");
}

void fields_write_particles(const char *directory, const struct study *study,
                            enum study_field field, struct lattice_results *results)
{
    const size_t count = (size_t)study->count;
    double *errors = allocate_or_exit(2 * FIELDS_METHODS * count, sizeof *errors);
    for (int k = 0; k < FIELDS_METHODS; k++) {
        const sphg_method method = fields_order[k];
        double *gradient_errors = errors + (size_t)k * count;
        double *curl_errors = errors + (size_t)(FIELDS_METHODS + k) * count;
        results->errors[field][method][0] =
            study_measure(study, field, method, gradient_errors, curl_errors);
    }
    char name[64];
    snprintf(name, sizeof name, "fields_%s_%s.csv", study_field_name(field), results->name);
    FILE *file = plot_file(directory, name);
    write_header(file);
    for (int32_t i = 0; i < study->count; i++)
        write_row(file, study, field, i, errors);
    plot_close(file, name);
    free(errors);
}

static void write_series(FILE *file, const struct lattice_results *results, enum study_field field,
                         sphg_method method)
{
    for (int size = 0; size < FIELDS_SIZES; size++) {
        const struct study_errors *errors = &results->errors[field][method][size];
        const int32_t side = results->setting.side << size;
        fprintf(file, "%s,%s,%s,%d,%.9g,%.4e,%.4e,%.4e,%.4e,%.4e\n", results->name,
                study_field_name(field), method_names[method], side, 2.0 / side,
                errors->boundary_max, errors->boundary_mean, errors->inside_max,
                errors->inside_mean, errors->curl_max);
    }
}

void fields_write_convergence(const char *directory, const struct lattice_results *results,
                              int count)
{
    const char *name = "fields_convergence.csv";
    FILE *file = plot_file(directory, name);
    fprintf(file, "lattice,field,method,N,spacing,boundary_max,boundary_mean,inside_max,"
                  "inside_mean,curl_max\n");
    for (int lattice = 0; lattice < count; lattice++)
        for (int field = 0; field < FIELDS_KINDS; field++)
            for (int k = 0; k < FIELDS_METHODS; k++)
                write_series(file, &results[lattice], (enum study_field)field, fields_order[k]);
    plot_close(file, name);
}
