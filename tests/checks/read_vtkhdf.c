/* SPDX-License-Identifier: MIT */
/* read_vtkhdf FILE FIELD TIME: whether FILE is what the reader of VTK 9.1 asks for: VTKHDF 1.0, an
 * UnstructuredGrid of vertices, with a vector FIELD beside the points; and what later ones ask for
 * beyond: a group Steps of one step, at TIME. Says the first thing that is wrong. */
#include <hdf5.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void demand(bool good, const char *what)
{
    if (good)
        return;
    fprintf(stderr, "%s\n", what);
    exit(EXIT_FAILURE);
}

static void check_version(hid_t group)
{
    int64_t version[2] = {0, 0};
    const hid_t attribute = H5Aopen(group, "Version", H5P_DEFAULT);
    demand(attribute >= 0 && H5Aread(attribute, H5T_NATIVE_INT64, version) >= 0, "no Version");
    demand(version[0] == 1 && version[1] == 0, "Version is not 1.0");
    H5Aclose(attribute);
}

static void check_type(hid_t group)
{
    char text[64] = "";
    const hid_t attribute = H5Aopen(group, "Type", H5P_DEFAULT);
    demand(attribute >= 0, "no Type");
    const hid_t type = H5Aget_type(attribute);
    demand(H5Tis_variable_str(type) == 0 && H5Tget_size(type) < sizeof text,
           "Type is no string of fixed length");
    demand(H5Aread(attribute, type, text) >= 0 && strcmp(text, "UnstructuredGrid") == 0,
           "Type is not UnstructuredGrid");
    H5Tclose(type);
    H5Aclose(attribute);
}

/* The numbers of a dataset that must have `count` rows of `columns`, as a table or a row. */
static double *read_of(hid_t group, const char *name, int dimensions, hsize_t count,
                       hsize_t columns)
{
    hsize_t sizes[2] = {0, 1};
    const hid_t set = H5Dopen2(group, name, H5P_DEFAULT);
    demand(set >= 0, name);
    const hid_t space = H5Dget_space(set);
    demand(H5Sget_simple_extent_ndims(space) == dimensions, name);
    H5Sget_simple_extent_dims(space, sizes, NULL);
    demand(sizes[0] == count && sizes[1] == columns, name);
    double *values = calloc(count * columns, sizeof *values);
    demand(values && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0,
           name);
    H5Sclose(space);
    H5Dclose(set);
    return values;
}

static double *read(hid_t group, const char *name, hsize_t count, hsize_t columns)
{
    return read_of(group, name, columns > 1 ? 2 : 1, count, columns);
}

static hsize_t read_count(hid_t group, const char *name)
{
    double *value = read(group, name, 1, 1);
    const hsize_t count = (hsize_t)*value;
    free(value);
    return count;
}

static void check_cells(hid_t group, hsize_t count)
{
    double *connectivity = read(group, "Connectivity", count, 1);
    double *offsets = read(group, "Offsets", count + 1, 1);
    double *types = read(group, "Types", count, 1);
    for (hsize_t i = 0; i < count; ++i)
        demand(connectivity[i] == (double)i && offsets[i] == (double)i && types[i] == 1,
               "a cell is not the vertex of its point");
    demand(offsets[count] == (double)count, "Offsets do not end with the number of cells");
    free(connectivity);
    free(offsets);
    free(types);
}

/* Finite, and not all of them zero. */
static void check_numbers(hid_t group, const char *name, hsize_t count)
{
    double *values = read(group, name, count, 3), sum = 0;
    for (hsize_t k = 0; k < 3 * count; ++k)
        sum += fabs(values[k]);
    demand(isfinite(sum) && sum > 0, name);
    free(values);
}

/* One step, at this time, of one part in which everything begins at the beginning. */
static void check_steps(hid_t group, const char *field, double time)
{
    static const struct {
        const char *name;
        int dimensions;
        double value;
    } sets[] = {{"NumberOfParts", 1, 1}, {"PartOffsets", 1, 0},           {"PointOffsets", 1, 0},
                {"CellOffsets", 2, 0},   {"ConnectivityIdOffsets", 2, 0}, {"Values", 1, NAN}};
    int64_t steps = 0;
    const hid_t attribute = H5Aopen(group, "NSteps", H5P_DEFAULT);
    demand(attribute >= 0 && H5Aread(attribute, H5T_NATIVE_INT64, &steps) >= 0 && steps == 1,
           "NSteps is not 1");
    H5Aclose(attribute);
    for (size_t k = 0; k < sizeof sets / sizeof sets[0]; ++k) {
        double *value = read_of(group, sets[k].name, sets[k].dimensions, 1, 1);
        const double wanted = isnan(sets[k].value) ? time : sets[k].value;
        demand(fabs(*value - wanted) <= 1e-9 * fabs(wanted), sets[k].name);
        free(value);
    }
    const hid_t data = H5Gopen2(group, "PointDataOffsets", H5P_DEFAULT);
    demand(data >= 0, "no group PointDataOffsets");
    double *offset = read_of(data, field, 1, 1, 1);
    demand(*offset == 0, "the field does not begin at the beginning");
    free(offset);
    H5Gclose(data);
}

int main(int argc, char **argv)
{
    demand(argc == 4, "usage: read_vtkhdf FILE FIELD TIME");
    const hid_t file = H5Fopen(argv[1], H5F_ACC_RDONLY, H5P_DEFAULT);
    demand(file >= 0, "no HDF5 file");
    const hid_t group = H5Gopen2(file, "VTKHDF", H5P_DEFAULT);
    demand(group >= 0, "no group VTKHDF");
    check_version(group);
    check_type(group);
    const hsize_t count = read_count(group, "NumberOfPoints");
    demand(count > 0 && read_count(group, "NumberOfCells") == count &&
               read_count(group, "NumberOfConnectivityIds") == count,
           "counts disagree");
    check_cells(group, count);
    check_numbers(group, "Points", count);
    const hid_t data = H5Gopen2(group, "PointData", H5P_DEFAULT);
    demand(data >= 0, "no group PointData");
    check_numbers(data, argv[2], count);
    H5Gclose(data);
    const hid_t steps = H5Gopen2(group, "Steps", H5P_DEFAULT);
    demand(steps >= 0, "no group Steps");
    check_steps(steps, argv[2], atof(argv[3]));
    H5Gclose(steps);
    H5Gclose(group);
    H5Fclose(file);
    return EXIT_SUCCESS;
}
