#include <cstring>
#include <vector>

#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::loop_angles;

namespace {

std::vector<std::uint32_t> small_table() {
  std::vector<JointVector<double, 6>> program;
  for (int i = 0; i <= 4; ++i) {
    program.push_back(loop_angles<double>(0.05 * i));
  }
  std::vector<std::uint32_t> words(1 << 16);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_path_table<double, 6>(kr270<double>(), program.data(), program.size(),
                                                 {1600, 20, 1e-4, 1e-4, 0}, words.data(),
                                                 4 * words.size(), &size)));
  words.resize(size / 4);
  return words;
}

Result open(const std::vector<std::uint32_t>& words, std::size_t size) {
  Table table;
  const Result result = Table::open(words.data(), size, &table);
  TEST_ASSERT_EQUAL(result == Result::ok, table.is_open());
  return result;
}

void a_table_opens_where_it_lies() {
  const std::vector<std::uint32_t> words = small_table();
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  TEST_ASSERT_TRUE(table.model_hash() == model_hash(kr270<double>()));
  TEST_ASSERT_TRUE(table.chart() == Chart::path);
  TEST_ASSERT_TRUE(reinterpret_cast<const unsigned char*>(table.record(0)) >
                   reinterpret_cast<const unsigned char*>(words.data()));
}

void every_wrong_byte_is_noticed() {
  std::vector<std::uint32_t> words = small_table();
  const std::size_t size = 4 * words.size();
  auto* bytes = reinterpret_cast<unsigned char*>(words.data());
  for (std::size_t i = 0; i < size; ++i) {
    const unsigned char right = bytes[i];
    for (unsigned wrong = 0; wrong < 256; ++wrong) {
      if (wrong == right) {
        continue;
      }
      bytes[i] = static_cast<unsigned char>(wrong);
      Table table;
      TEST_ASSERT_FALSE(Table::open(words.data(), size, &table) == Result::ok);
    }
    bytes[i] = right;
  }
  TEST_ASSERT_EQUAL(Result::ok, open(words, size));
}

void every_truncation_is_noticed() {
  const std::vector<std::uint32_t> words = small_table();
  for (std::size_t size = 0; size < 4 * words.size(); ++size) {
    TEST_ASSERT_EQUAL(Result::table_truncated, open(words, size));
  }
}

void bytes_after_the_end_are_noticed() {
  std::vector<std::uint32_t> words = small_table();
  words.push_back(0);
  TEST_ASSERT_EQUAL(Result::table_corrupt, open(words, 4 * words.size()));
}

/// CRC-32 bit by bit, as IEEE 802.3 words it, of little-endian words.
std::uint32_t crc32_of(const std::vector<std::uint32_t>& words) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint32_t word : words) {
    crc ^= word;
    for (int bit = 0; bit < 32; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    }
  }
  return ~crc;
}

/// A width that is not a number would let a program stray any distance from the path, and such a
/// largest gain any gain pass.
void a_number_that_is_not_finite_is_refused_even_with_the_right_checksum() {
  const std::vector<std::uint32_t> right = small_table();
  const std::size_t first_number = offsetof(TableHeader, grid_lower) / 4;
  for (const std::uint32_t wrong : {0x7FC00000U, 0x7F800000U, 0xFF800000U}) {
    for (std::size_t i = first_number; i < right.size(); ++i) {
      std::vector<std::uint32_t> words = right;
      words[i] = wrong;
      words[3] = 0;
      words[3] = crc32_of(words);
      TEST_ASSERT_EQUAL(Result::table_corrupt, open(words, 4 * words.size()));
    }
  }
}

void other_files_and_versions_are_told_apart() {
  std::vector<std::uint32_t> words = small_table();
  words[1] = kTableVersion + 1;
  TEST_ASSERT_EQUAL(Result::table_version, open(words, 4 * words.size()));
  words[0] = 0x464C457F;
  TEST_ASSERT_EQUAL(Result::table_not_a_table, open(words, 4 * words.size()));
}

void a_table_must_be_aligned_and_there() {
  std::vector<std::uint32_t> words = small_table();
  words.push_back(0);
  auto* bytes = reinterpret_cast<unsigned char*>(words.data());
  std::memmove(bytes + 1, bytes, 4 * words.size() - 4);
  Table table;
  TEST_ASSERT_EQUAL(Result::table_misaligned, Table::open(bytes + 1, 4 * words.size() - 4, &table));
  TEST_ASSERT_EQUAL(Result::bad_argument, Table::open(nullptr, 100, &table));
  TEST_ASSERT_EQUAL(Result::bad_argument, Table::open(words.data(), 4 * words.size(), nullptr));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_table_opens_where_it_lies);
  RUN_TEST(every_wrong_byte_is_noticed);
  RUN_TEST(every_truncation_is_noticed);
  RUN_TEST(bytes_after_the_end_are_noticed);
  RUN_TEST(a_number_that_is_not_finite_is_refused_even_with_the_right_checksum);
  RUN_TEST(other_files_and_versions_are_told_apart);
  RUN_TEST(a_table_must_be_aligned_and_there);
  return UNITY_END();
}
