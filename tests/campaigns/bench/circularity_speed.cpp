/// The four reference circles of a measured profile by flexcomp, and those of them that CGAL can
/// find: the minimum zone (as the annulus of least difference of squared radii, which is the same
/// where the form error is small) and the minimum circumscribed circle.
///
///   bench_circularity FOLDER N... [options of Google Benchmark]
///
/// measures on the profiles FOLDER/N.f64: N points, x and y in turn, m, doubles of this machine.
/// The counter `found` is the form error (LSC, MZC), the largest inscribed or the least
/// circumscribed radius, m.
#include <CGAL/Gmpzf.h>
#include <CGAL/Min_annulus_d.h>
#include <CGAL/Min_sphere_annulus_d_traits_2.h>
#include <CGAL/Min_sphere_d.h>
#include <CGAL/Simple_cartesian.h>
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include "geometry/circularity.hpp"

using namespace flexcomp::geometry;

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using CgalPoints = std::vector<Kernel::Point_2>;

struct Profile {
  Points points;
  CgalPoints for_cgal;
};

bool read(const std::string& file, std::size_t count, Profile* profile) {
  std::vector<double> numbers(2 * count);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(numbers.data()),
              static_cast<std::streamsize>(numbers.size() * sizeof(double)));
  for (std::size_t i = 0; i < count; ++i) {
    profile->points.emplace_back(numbers[2 * i], numbers[2 * i + 1]);
    profile->for_cgal.emplace_back(numbers[2 * i], numbers[2 * i + 1]);
  }
  return stream.good();
}

double form_error(const Circularity& found) { return found.value(); }
double inner_radius(const Circularity& found) { return found.r_min; }
double outer_radius(const Circularity& found) { return found.r_max; }

double cgal_zone(const CgalPoints& points) {
  // Approximate pricing in doubles, exact arithmetic where it decides: CGAL's fastest choice.
  using Traits = CGAL::Min_sphere_annulus_d_traits_2<Kernel, CGAL::Gmpzf, double>;
  const CGAL::Min_annulus_d<Traits> annulus(points.begin(), points.end());
  const double denominator = CGAL::to_double(annulus.squared_radii_denominator());
  return std::sqrt(CGAL::to_double(annulus.squared_outer_radius_numerator()) / denominator) -
         std::sqrt(CGAL::to_double(annulus.squared_inner_radius_numerator()) / denominator);
}

double cgal_circumscribed(const CgalPoints& points) {
  using Traits = CGAL::Min_sphere_annulus_d_traits_2<Kernel>;
  const CGAL::Min_sphere_d<Traits> sphere(points.begin(), points.end());
  return std::sqrt(sphere.squared_radius());
}

template <typename Find>
void measure(const std::string& name, std::size_t count, const Find& find) {
  benchmark::RegisterBenchmark((name + "/" + std::to_string(count)).c_str(), [=](benchmark::State&
                                                                                     state) {
    double found = 0;
    for (auto _ : state) {
      found = find();
      benchmark::DoNotOptimize(found);
    }
    state.counters["found"] = found;
    state.counters["s"] = benchmark::Counter(
        1, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  })->Unit(benchmark::kMillisecond);
}

void measure_all(std::size_t count, const Profile& profile) {
  const auto ours = [&](const char* name, auto method, auto value) {
    measure(name, count, [&profile, method, value] { return value(method(profile.points)); });
  };
  ours("LSC flexcomp", least_squares_circularity, form_error);
  ours("MZC flexcomp", minimum_zone_circularity, form_error);
  ours("MIC flexcomp", maximum_inscribed_circularity, inner_radius);
  ours("MCC flexcomp", minimum_circumscribed_circularity, outer_radius);
  measure("MZC CGAL", count, [&profile] { return cgal_zone(profile.for_cgal); });
  measure("MCC CGAL", count, [&profile] { return cgal_circumscribed(profile.for_cgal); });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc < 3) {
    std::fprintf(stderr, "usage: bench_circularity FOLDER N...\n");
    return 2;
  }
  std::map<std::size_t, Profile> profiles;
  for (int i = 2; i < argc; ++i) {
    const std::size_t count = std::stoul(argv[i]);
    const std::string file = std::string(argv[1]) + "/" + argv[i] + ".f64";
    if (!read(file, count, &profiles[count])) {
      std::fprintf(stderr, "bench_circularity: cannot read %s\n", file.c_str());
      return 2;
    }
    measure_all(count, profiles[count]);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
