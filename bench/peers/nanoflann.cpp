/* SPDX-License-Identifier: MIT */
// nanoflann: a k-d tree over the host's array.
#include "peer.h"
#include <cstdio>
#include <nanoflann.hpp>
#include <vector>

namespace
{

struct cloud {
    const double (*positions)[3];
    std::size_t count;

    std::size_t kdtree_get_point_count() const
    {
        return count;
    }
    double kdtree_get_pt(std::size_t i, std::size_t axis) const
    {
        return positions[i][axis];
    }
    template <class box> bool kdtree_get_bbox(box &) const
    {
        return false;
    }
};

using tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, cloud>, cloud,
                                                 3, std::uint32_t>;

} // namespace

const char *peer_name()
{
    static char text[32];
    std::snprintf(text, sizeof text, "nanoflann %d.%d.%d", NANOFLANN_VERSION / 256,
                  NANOFLANN_VERSION / 16 % 16, NANOFLANN_VERSION % 16);
    return text;
}

int64_t peer_search(const double (*positions)[3], int32_t count, double radius, int64_t *offsets,
                    int32_t *indices, int64_t room)
{
    const cloud points = {positions, static_cast<std::size_t>(count)};
    const tree index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(10));
    const nanoflann::SearchParams unsorted(32, 0, false);
    std::vector<std::pair<std::uint32_t, double>> found;
    int64_t pairs = 0;
    for (int32_t i = 0; i < count; ++i) {
        offsets[i] = pairs;
        index.radiusSearch(positions[i], radius * radius, found, unsorted);
        for (const auto &one : found)
            if (one.first != static_cast<std::uint32_t>(i) && pairs < room)
                indices[pairs++] = static_cast<int32_t>(one.first);
    }
    offsets[count] = pairs;
    return pairs;
}
