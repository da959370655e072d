#include <cmath>
#include <cstddef>
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

std::vector<std::uint32_t> grid_table() {
  const GridRange<double> ranges[4] = {{-1.25, -1.15}, {1.25, 1.35}, {0.3, 0.3}, {0.8, 0.8}};
  std::vector<std::uint32_t> words(1 << 14);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_grid_table<double, 6>(kr270<double>(), ranges, {1600, 20, 1e-4, 1e-4, 0},
                                                 words.data(), 4 * words.size(), &size)));
  words.resize(size / 4);
  return words;
}

constexpr std::size_t word_of(std::size_t offset) { return offset / 4; }

struct Contradiction {
  std::size_t word;
  std::uint32_t value;
};

void assert_refused(const std::vector<std::uint32_t>& right, const Contradiction& wrong) {
  std::vector<std::uint32_t> words = right;
  words[wrong.word] = wrong.value;
  words[3] = 0;
  words[3] = crc32_of(words);
  TEST_ASSERT_EQUAL(Result::table_corrupt, open(words, 4 * words.size()));
}

void fields_that_contradict_each_other_are_refused_even_with_the_right_checksum() {
  const Contradiction of_any[] = {{word_of(offsetof(TableHeader, chart)), 0},
                                  {word_of(offsetof(TableHeader, chart)), 3},
                                  {word_of(offsetof(TableHeader, joints)), 7},
                                  {word_of(offsetof(TableHeader, contents)), 4},
                                  {word_of(offsetof(TableHeader, contents)), 1},
                                  {word_of(offsetof(TableHeader, record_size)), 1},
                                  {word_of(offsetof(TableHeader, record_size)), 0xFFFFFFFF},
                                  {word_of(offsetof(TableHeader, node_count)), 0},
                                  {word_of(offsetof(TableHeader, node_count)), 0xFFFFFFFF}};
  for (const Contradiction& wrong : of_any) {
    assert_refused(small_table(), wrong);
    assert_refused(grid_table(), wrong);
  }
  const Contradiction of_grids[] = {{word_of(offsetof(TableHeader, grid_axes)), 0},
                                    {word_of(offsetof(TableHeader, grid_axes)), 5},
                                    {word_of(offsetof(TableHeader, grid_nodes)), 1},
                                    {word_of(offsetof(TableHeader, grid_nodes)), 65536},
                                    {word_of(offsetof(TableHeader, grid_nodes)), 65535},
                                    {word_of(offsetof(TableHeader, grid_joint)), 6},
                                    {word_of(offsetof(TableHeader, grid_step)), 0},
                                    {word_of(offsetof(TableHeader, grid_step)), 0xBF800000}};
  for (const Contradiction& wrong : of_grids) {
    assert_refused(grid_table(), wrong);
  }
}

void a_path_of_one_node_is_no_path() {
  std::vector<std::uint32_t> words = small_table();
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  words.resize(sizeof(TableHeader) / 4 + table.header().record_size);
  words[2] = static_cast<std::uint32_t>(4 * words.size());
  assert_refused(words, {word_of(offsetof(TableHeader, node_count)), 1});
}

void a_size_that_is_no_multiple_of_a_word_is_refused() {
  std::vector<std::uint32_t> words = small_table();
  const auto size = static_cast<std::uint32_t>(4 * words.size() - 1);
  words[2] = size;
  TEST_ASSERT_EQUAL(Result::table_corrupt, open(words, size));
}

void limits_that_no_float_can_hold_are_none() {
  RobotModel<double, 6> model = kr270<double>();
  model.joints[3].lower = -1e300;
  model.joints[3].upper = 1e300;
  const std::vector<JointVector<double, 6>> program = {loop_angles<double>(0),
                                                       loop_angles<double>(0.1)};
  std::vector<std::uint32_t> words(1 << 12);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(
      Result::ok,
      (build_path_table<double, 6>(model, program.data(), program.size(), {1600, 20, 1e-4, 1e-4, 0},
                                   words.data(), 4 * words.size(), &size)));
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), size, &table));
  TEST_ASSERT_TRUE(table.header().joint_lower[3] < -3e38F);
}

void places_along_a_path_are_joint_angles_on_it() {
  const std::vector<std::uint32_t> words = small_table();
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  const std::uint32_t last = table.header().node_count - 1;
  for (const double place : {0.0, 0.5, 1.0}) {
    const double along = place * last;
    const auto node = static_cast<std::uint32_t>(std::floor(along));
    const double rest = along - node;
    const JointVector<double, 6> q = chart_angles<double, 6>(table, {place, 0, 0, 0});
    for (Eigen::Index i = 0; i < 6; ++i) {
      const auto from = static_cast<double>(table.record(node)[i]);
      const auto to = static_cast<double>(table.record(node < last ? node + 1 : node)[i]);
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, from + rest * (to - from), q[i]);
    }
  }
}

/// Such as one that was kept from a longer table.
void a_cursor_beyond_the_end_comes_back() {
  const std::vector<std::uint32_t> words = small_table();
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  TableCursor cursor{0xFFFFFFFF, 0xFFFFFFFF};
  static_cast<void>(look_up<double, 6>(table, loop_angles<double>(0.2), &cursor));
  TEST_ASSERT_TRUE(cursor.segment + 1 < table.header().node_count);
}

void every_wrong_byte_and_truncation_of_a_grid_is_noticed() {
  std::vector<std::uint32_t> words = grid_table();
  const std::size_t size = 4 * words.size();
  auto* bytes = reinterpret_cast<unsigned char*>(words.data());
  Table table;
  for (std::size_t i = 0; i < size; ++i) {
    for (unsigned flip = 1; flip < 256; ++flip) {
      bytes[i] ^= static_cast<unsigned char>(flip);
      TEST_ASSERT_FALSE(Table::open(words.data(), size, &table) == Result::ok);
      bytes[i] ^= static_cast<unsigned char>(flip);
    }
    TEST_ASSERT_EQUAL(Result::table_truncated, open(words, i));
  }
}

void other_files_and_versions_are_told_apart() {
  std::vector<std::uint32_t> words = small_table();
  const std::vector<std::uint32_t> short_text = {0x6c6c6568, 0x0000006f};  // "hello"
  TEST_ASSERT_EQUAL(Result::table_not_a_table, open(short_text, 5));
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
  RUN_TEST(fields_that_contradict_each_other_are_refused_even_with_the_right_checksum);
  RUN_TEST(a_path_of_one_node_is_no_path);
  RUN_TEST(a_size_that_is_no_multiple_of_a_word_is_refused);
  RUN_TEST(limits_that_no_float_can_hold_are_none);
  RUN_TEST(places_along_a_path_are_joint_angles_on_it);
  RUN_TEST(a_cursor_beyond_the_end_comes_back);
  RUN_TEST(every_wrong_byte_and_truncation_of_a_grid_is_noticed);
  RUN_TEST(other_files_and_versions_are_told_apart);
  RUN_TEST(a_table_must_be_aligned_and_there);
  return UNITY_END();
}
