#include "geometry/convex_hull.hpp"

#include <algorithm>
#include <numeric>

namespace flexcomp::geometry {

std::vector<std::size_t> convex_hull(const Points& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].x() < points[b].x() ||
           (points[a].x() == points[b].x() && points[a].y() < points[b].y());
  });
  std::vector<std::size_t> hull;
  const auto add_chain = [&](auto begin, auto end) {
    const std::size_t kept = hull.size();
    for (auto at = begin; at != end; ++at) {
      while (hull.size() >= kept + 2 && cross(points[hull.back()] - points[hull[hull.size() - 2]],
                                              points[*at] - points[hull.back()]) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*at);
    }
    hull.pop_back();  // the next chain begins with it
  };
  add_chain(order.begin(), order.end());
  add_chain(order.rbegin(), order.rend());
  return hull;
}

}  // namespace flexcomp::geometry
