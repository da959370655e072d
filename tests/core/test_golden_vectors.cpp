/// The core's numbers on this machine against those of another: golden_vectors.inc holds what a
/// host made of them (`test_core_golden_vectors --print`), to the bit. On the Cortex-M7 look-ups
/// multiply and add with one rounding, and sine and cosine are another library's. On AArch64
/// Eigen's packets multiply and add with one rounding everywhere. Compiled for wider registers
/// (AVX), sums are in another order.
#include <cstdio>
#include <cstring>
#include <limits>

#include "core/golden_values.hpp"
#include "unity_main.hpp"

using flexcomp::test::GoldenGroup;
using flexcomp::test::GoldenValues;

namespace {

#if defined(__x86_64__) && !defined(__AVX__)
constexpr double kUnits = 0;  // in the last place of a group's largest number
#elif defined(__aarch64__)
constexpr double kUnits = 4;
#else
constexpr double kUnits = 2;
#endif

const std::uint64_t golden_double[] = {
#define DOUBLE(bits) bits,
#define FLOAT(bits)
#include "core/golden_vectors.inc"
#undef DOUBLE
#undef FLOAT
};

const std::uint32_t golden_float[] = {
#define DOUBLE(bits)
#define FLOAT(bits) bits,
#include "core/golden_vectors.inc"
#undef DOUBLE
#undef FLOAT
};

template <typename Scalar, typename Bits>
Scalar from_bits(Bits bits) {
  static_assert(sizeof(Scalar) == sizeof(Bits));
  Scalar value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) {
    largest = std::max(largest, std::fabs(value));
  }
  return largest;
}

template <typename Scalar, typename Bits, std::size_t Size>
void compare(const GoldenValues<Scalar>& found, const Bits (&golden)[Size]) {
  std::size_t place = 0;
  double worst = 0;
  std::string worst_name;
  for (const GoldenGroup<Scalar>& group : found.groups()) {
    TEST_ASSERT_TRUE(place + group.values.size() <= Size);
    std::vector<double> expected;
    for (std::size_t i = 0; i < group.values.size(); ++i) {
      expected.push_back(static_cast<double>(from_bits<Scalar>(golden[place++])));
    }
    const double unit =
        largest_of(expected) * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      TEST_ASSERT_TRUE_MESSAGE(std::isfinite(group.values[i]), group.name.c_str());
      const double off = std::fabs(static_cast<double>(group.values[i]) - expected[i]);
      const double units = off > 0 ? off / unit : 0;
      worst_name = units > worst ? group.name : worst_name;
      worst = std::max(worst, units);
    }
  }
  TEST_ASSERT_EQUAL(Size, place);
  std::printf("%s: %.2f units in the last place at most%s%s\n",
              sizeof(Scalar) == 4 ? "float" : "double", worst, worst > 0 ? ", at " : "",
              worst_name.c_str());
  TEST_ASSERT_TRUE(worst <= kUnits);
}

void floats_are_those_of_the_host() { compare(GoldenValues<float>(), golden_float); }

void doubles_are_those_of_the_host() { compare(GoldenValues<double>(), golden_double); }

void floats_are_the_doubles_to_their_precision() {
  const GoldenValues<float> floats;
  const GoldenValues<double> doubles;
  TEST_ASSERT_EQUAL(doubles.groups().size(), floats.groups().size());
  for (std::size_t i = 0; i < doubles.groups().size(); ++i) {
    const std::vector<double>& expected = doubles.groups()[i].values;
    const std::vector<float>& found = floats.groups()[i].values;
    // Tables are built anew in each precision: they agree to the tolerance of the table, 20 µm.
    const bool by_table = doubles.groups()[i].name.find("table") != std::string::npos ||
                          doubles.groups()[i].name.find("correction") != std::string::npos;
    const double allowed = by_table ? 3e-5 : 2e-5 * largest_of(expected);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      TEST_ASSERT_DOUBLE_WITHIN(allowed, expected[k], static_cast<double>(found[k]));
    }
  }
}

template <typename Scalar, typename Bits>
void print(const char* macro, const char* format) {
  const GoldenValues<Scalar> made;
  for (const auto& group : made.groups()) {
    for (const Scalar value : group.values) {
      Bits bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      std::printf("%s(", macro);
      std::printf(format, bits);
      std::printf(")\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--print") == 0) {
    std::printf("// Written by test_core_golden_vectors --print; units as the core's.\n");
    print<double, unsigned long long>("DOUBLE", "0x%016llxULL");
    print<float, unsigned int>("FLOAT", "0x%08xU");
    return 0;
  }
  UNITY_BEGIN();
  RUN_TEST(floats_are_those_of_the_host);
  RUN_TEST(doubles_are_those_of_the_host);
  RUN_TEST(floats_are_the_doubles_to_their_precision);
  return UNITY_END();
}
