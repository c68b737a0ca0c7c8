/* SPDX-License-Identifier: MIT */
// CGAL: a k-d tree of points with their numbers, searched with fuzzy spheres that are not fuzzy.
#include "peer.h"
#include <CGAL/Fuzzy_sphere.h>
#include <CGAL/Kd_tree.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>
#include <CGAL/version.h>
#include <iterator>
#include <tuple>
#include <vector>

namespace
{

using kernel = CGAL::Simple_cartesian<double>;
using point = std::tuple<kernel::Point_3, int32_t>;
using traits = CGAL::Search_traits_adapter<point, CGAL::Nth_of_tuple_property_map<0, point>,
                                           CGAL::Search_traits_3<kernel>>;
using sphere = CGAL::Fuzzy_sphere<traits>;

} // namespace

const char *peer_name()
{
    return "CGAL " CGAL_VERSION_STR;
}

int64_t peer_search(const double (*positions)[3], int32_t count, double radius, int64_t *offsets,
                    int32_t *indices, int64_t room)
{
    std::vector<point> points;
    for (int32_t i = 0; i < count; ++i)
        points.emplace_back(kernel::Point_3(positions[i][0], positions[i][1], positions[i][2]), i);
    CGAL::Kd_tree<traits> tree(points.begin(), points.end());
    tree.build();
    std::vector<point> found;
    int64_t pairs = 0;
    for (int32_t i = 0; i < count; ++i) {
        offsets[i] = pairs;
        found.clear();
        tree.search(std::back_inserter(found),
                    sphere(std::get<0>(points[static_cast<std::size_t>(i)]), radius, 0));
        for (const point &one : found)
            if (std::get<1>(one) != i && pairs < room)
                indices[pairs++] = std::get<1>(one);
    }
    offsets[count] = pairs;
    return pairs;
}
