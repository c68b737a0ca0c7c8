/* SPDX-License-Identifier: MIT */
#include "vtkhdf.h"
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

bool vtkhdf_is_there(void)
{
    return true;
}

/* count 0: a single number. */
static bool write_attribute(hid_t group, const char *name, hid_t type, int32_t count,
                            const void *data)
{
    const hsize_t size = (hsize_t)count;
    const hid_t space = count ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = H5Awrite(attribute, type, data) >= 0;
    H5Aclose(attribute);
    H5Sclose(space);
    return good;
}

/* columns 0: one-dimensional. */
static bool write_data(hid_t group, const char *name, hid_t stored, hid_t given, int32_t rows,
                       int32_t columns, const void *data)
{
    const hsize_t sizes[2] = {(hsize_t)rows, (hsize_t)columns};
    const hid_t space = H5Screate_simple(columns ? 2 : 1, sizes, NULL);
    const hid_t set = H5Dcreate2(group, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = H5Dwrite(set, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    H5Dclose(set);
    H5Sclose(space);
    return good;
}

static bool write_version(hid_t group)
{
    const int64_t version[2] = {1, 0};
    return write_attribute(group, "Version", H5T_NATIVE_INT64, 2, version);
}

/* A string of fixed length: readers of version 1.0 refuse one of variable length. */
static bool write_type(hid_t group)
{
    static const char text[] = "UnstructuredGrid";
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text));
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    const bool good = write_attribute(group, "Type", type, 0, text);
    H5Tclose(type);
    return good;
}

static bool write_counts(hid_t group, int32_t count)
{
    static const char *const names[] = {"NumberOfPoints", "NumberOfCells",
                                        "NumberOfConnectivityIds"};
    const int64_t number = count;
    bool good = true;
    for (int k = 0; k < 3; ++k)
        good =
            good && write_data(group, names[k], H5T_NATIVE_INT64, H5T_NATIVE_INT64, 1, 0, &number);
    return good;
}

/* Cell i is the vertex of point i. */
static bool write_cells(hid_t group, int32_t count)
{
    int64_t *numbers = array_new(count + 1, sizeof *numbers);
    uint8_t *types = array_new(count, sizeof *types);
    memset(types, 1, (size_t)count); /* VTK_VERTEX */
    for (int32_t i = 0; i <= count; ++i)
        numbers[i] = i;
    const hid_t whole = H5T_NATIVE_INT64;
    const bool good =
        write_data(group, "Connectivity", whole, whole, count, 0, numbers) &&
        write_data(group, "Offsets", whole, whole, count + 1, 0, numbers) &&
        write_data(group, "Types", H5T_NATIVE_UINT8, H5T_NATIVE_UINT8, count, 0, types);
    free(numbers);
    free(types);
    return good;
}

static bool write_points(hid_t group, int32_t count, vector *x, const struct output_field *fields)
{
    bool good = write_data(group, "Points", H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE, count, 3, x);
    const hid_t data = H5Gcreate2(group, "PointData", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    for (const struct output_field *field = fields; field->name; ++field)
        good = good && write_data(data, field->name, H5T_NATIVE_FLOAT, H5T_NATIVE_DOUBLE, count,
                                  field->dimension == 1 ? 0 : field->dimension, field->values);
    H5Gclose(data);
    return good;
}

/* Of the file's one moment: when it is, and that everything of it begins at the beginning. Readers
 * that know no times leave the group alone. */
static bool write_steps(hid_t group, double time, const struct output_field *fields)
{
    static const char *const names[] = {"PartOffsets", "PointOffsets", "CellOffsets",
                                        "ConnectivityIdOffsets"};
    const int64_t zero = 0, one = 1;
    const hid_t whole = H5T_NATIVE_INT64;
    const hid_t steps = H5Gcreate2(group, "Steps", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t data = H5Gcreate2(steps, "PointDataOffsets", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = write_attribute(steps, "NSteps", whole, 0, &one) &&
                write_data(steps, "Values", H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, 1, 0, &time) &&
                write_data(steps, "NumberOfParts", whole, whole, 1, 0, &one);
    for (int k = 0; k < 4; ++k) /* cells may be of several kinds, in columns */
        good = good && write_data(steps, names[k], whole, whole, 1, k < 2 ? 0 : 1, &zero);
    for (const struct output_field *field = fields; field->name; ++field)
        good = good && write_data(data, field->name, whole, whole, 1, 0, &zero);
    H5Gclose(data);
    H5Gclose(steps);
    return good;
}

bool vtkhdf_write(const char *path, double time, int32_t count, vector *x,
                  const struct output_field *fields)
{
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (file < 0)
        return false;
    const hid_t group = H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = write_version(group) && write_type(group) && write_counts(group, count) &&
                      write_cells(group, count) && write_points(group, count, x, fields) &&
                      write_steps(group, time, fields);
    H5Gclose(group);
    return H5Fclose(file) >= 0 && good;
}
