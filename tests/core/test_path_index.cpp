#include <limits>
#include <random>
#include <vector>

#include "cases.hpp"
#include "core/long_program.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/path_index.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::cases;
using flexcomp::test::kr270;
using flexcomp::test::loop_angles;
using flexcomp::test::Raster;

namespace {

using Angles = JointVector<float, 6>;
using Words = std::vector<std::uint32_t>;  // no more than the table: a sanitizer sees its end

constexpr double kTurn = 6.28318530717958647692;
constexpr Raster kRaster = {cases(1000), 6};

Table reopen(const Words& words) {
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::reopen(words.data(), 4 * words.size(), &table));
  return table;
}

/// A table with its index, and without.
struct Indexed {
  Words words;
  Words memory;
  Table table;
  Table plain;

  explicit Indexed(Words table_words) : words(std::move(table_words)) {
    plain = reopen(words);
    table = plain;
    memory.resize(path_index_size(table) / 4);
    TEST_ASSERT_EQUAL(Result::ok, index_path(memory.data(), 4 * memory.size(), &table));
  }

  std::uint32_t segments() const { return table.header().node_count - 1; }
};

const Indexed& raster() {
  static const Indexed kIndexed(test::raster_table(kRaster));
  return kIndexed;
}

Words built(const std::vector<Angles>& program) {
  Words words(1 << 17);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_path_table<float, 6>(kr270<float>(), program.data(), program.size(),
                                                {1600, 20, 5e-6F, 5e-6F, 0}, words.data(),
                                                4 * words.size(), &size)));
  return {words.begin(), words.begin() + static_cast<std::ptrdiff_t>(size / 4)};
}

float outside(const Table& table, const Angles& q, TableCursor cursor) {
  return look_up<float, 6>(table, q, &cursor).outside;
}

/// Of all segments, the one that `q` is least outside.
float least_outside(const Table& plain, const Angles& q) {
  TableCursor cursor;
  locate<float, 6>(plain, q, &cursor);
  return outside(plain, q, cursor);
}

TableCursor anywhere(const Indexed& indexed, std::mt19937* random) {
  TableCursor cursor;
  cursor.segment = static_cast<std::uint32_t>((*random)() % indexed.segments());
  return cursor;
}

Angles on_raster(std::mt19937* random) {
  const int node = static_cast<int>((*random)() % static_cast<unsigned>(kRaster.nodes() - 1));
  return kRaster.between(node, static_cast<float>((*random)() % 1000) / 1000.0F);
}

void a_jump_on_a_long_program_is_caught_up_with_in_five_look_ups() {
  std::mt19937 random(1);
  for (int i = 0; i < cases(20000); ++i) {
    TableCursor cursor = anywhere(raster(), &random);
    const Angles q = on_raster(&random);
    for (int look_ups = 1; outside(raster().table, q, cursor) > 0.0F; ++look_ups) {
      TEST_ASSERT_TRUE(look_ups < 5);
      look_up<float, 6>(raster().table, q, &cursor);
    }
  }
}

void arming_finds_the_place_at_once() {
  std::mt19937 random(2);
  for (int i = 0; i < cases(20000); ++i) {
    TableCursor cursor = anywhere(raster(), &random);
    const Angles q = on_raster(&random);
    locate<float, 6>(raster().table, q, &cursor);
    TEST_ASSERT_TRUE(outside(raster().table, q, cursor) == 0.0F);
  }
}

/// Off the program the place found is at most twice as far outside as the nearest.
void check_near(const Indexed& indexed, const Angles& q, TableCursor cursor) {
  for (int i = 0; i < 40; ++i) {
    look_up<float, 6>(indexed.table, q, &cursor);
  }
  const float least = least_outside(indexed.plain, q);
  TEST_ASSERT_TRUE(outside(indexed.table, q, cursor) <= 2 * least + 1e-6F);
}

void off_the_program_something_near_is_found() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> off(-1, 1);
  for (int i = 0; i < cases(300); ++i) {
    Angles q = on_raster(&random);
    const float size = std::pow(10.0F, -4.0F + 3.0F * std::abs(off(random)));
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      q[joint] += size * off(random);
    }
    check_near(raster(), q, anywhere(raster(), &random));
  }
}

/// Segments that no direction tells apart: the same round again and again.
void a_program_that_repeats_itself_is_found_too() {
  std::vector<Angles> rounds;
  for (int i = 0; i <= 20 * 60; ++i) {
    rounds.push_back(loop_angles<float>(kTurn * (i % 60) / 60));
  }
  const Indexed indexed(built(rounds));
  std::mt19937 random(4);
  for (int i = 0; i < cases(2000); ++i) {
    TableCursor cursor = anywhere(indexed, &random);
    const Angles q = rounds[random() % rounds.size()];
    locate<float, 6>(indexed.table, q, &cursor);
    TEST_ASSERT_TRUE(outside(indexed.table, q, cursor) == 0.0F);
  }
}

void programs_of_a_few_segments_have_an_index_too() {
  for (int points = 2; points < 30; ++points) {
    std::vector<Angles> program;
    for (int i = 0; i < points; ++i) {
      program.push_back(loop_angles<float>(0.02 * i));
      program.back()[1] += i % 2 == 0 ? 0.01F : 0.0F;
    }
    const Indexed indexed(built(program));
    for (const Angles& q : program) {
      TableCursor cursor;
      locate<float, 6>(indexed.table, q, &cursor);
      TEST_ASSERT_TRUE(outside(indexed.table, q, cursor) == 0.0F);
    }
  }
}

void following_the_program_needs_no_search() {
  TableCursor cursor;
  for (int node = 0; node + 1 < kRaster.nodes(); ++node) {
    look_up<float, 6>(raster().table, kRaster.between(node, 0.5F), &cursor);
    TEST_ASSERT_EQUAL(node, cursor.segment);
    TEST_ASSERT_EQUAL(0, cursor.searched);
  }
}

void the_index_does_not_change_what_is_read() {
  const Indexed& indexed = raster();
  std::mt19937 random(5);
  Wrench<float> wrench;
  wrench << 440, 1370, 635, 0, 3, 10.5F;
  for (int i = 0; i < cases(1000); ++i) {
    const Angles q = on_raster(&random);
    TableCursor cursor;
    locate<float, 6>(indexed.table, q, &cursor);
    TableCursor other = cursor;
    float off = 0;
    const auto with = look_up_response<float, 6>(indexed.table, q, wrench, &cursor, &off);
    const auto without = look_up_response<float, 6>(indexed.plain, q, wrench, &other, &off);
    TEST_ASSERT_TRUE(with.deflection == without.deflection);
    TEST_ASSERT_TRUE(with.correction == without.correction);
  }
}

/// Memory of the index that has changed, and cursors from anywhere, lead nowhere else than to the
/// table's own segments.
void a_damaged_index_is_no_danger() {
  Indexed indexed(test::raster_table({20, 6}));
  const Words intact = indexed.memory;
  std::mt19937 random(6);
  for (int i = 0; i < cases(20000); ++i) {
    if (i % 100 == 0) {
      indexed.memory = intact;
    }
    indexed.memory[random() % indexed.memory.size()] ^= 1U << (random() % 32);
    TableCursor cursor = {static_cast<std::uint32_t>(random()),
                          static_cast<std::uint32_t>(random()) >> (random() % 32),
                          static_cast<std::uint32_t>(random()), random() % 2 == 0};
    const Angles q = kRaster.between(static_cast<int>(i % 100), 0.5F);
    if (i % 2 == 0) {
      locate<float, 6>(indexed.table, q, &cursor);
    }
    const TableEntry<float, 6> entry = look_up<float, 6>(indexed.table, q, &cursor);
    TEST_ASSERT_TRUE(entry.jacobian.allFinite());
    TEST_ASSERT_TRUE(cursor.segment < indexed.segments());
  }
}

void however_far_off_the_search_ends() {
  for (const float far : {std::numeric_limits<float>::max(), -std::numeric_limits<float>::max()}) {
    TableCursor cursor;
    const Angles q = Angles::Constant(far);
    locate<float, 6>(raster().table, q, &cursor);
    TEST_ASSERT_TRUE(outside(raster().table, q, cursor) > 1e30F);
  }
}

/// Jumps by more than its joints can go, which is a fault of one tick, and is back.
void a_compensator_corrects_again_soon_after_a_jump() {
  Compensator<float, 6> core;
  CompensatorConfig<float, 6> config = test::compensator_config();
  config.ready_ticks = 5;
  TEST_ASSERT_EQUAL(Result::ok, core.configure(config));
  TEST_ASSERT_EQUAL(Result::ok, core.set_table(raster().table));
  CompensatorInput<float, 6> input{kRaster.between(100, 0.5F), 0.001F, Wrench<float>::Zero(),
                                   0.001F};
  for (int i = 0; i < 10; ++i) {
    core.tick(input);
  }
  TEST_ASSERT_EQUAL(Result::ok, core.arm());
  std::mt19937 random(7);
  for (int i = 0; i < cases(1000); ++i) {
    input.setpoint = on_raster(&random);
    core.tick(input);
    std::uint32_t status = 0;
    for (int tick = 0; tick < 5; ++tick) {
      status = core.tick(input).status;
    }
    TEST_ASSERT_EQUAL_HEX32(0, status & kFaultBits);
  }
}

void what_cannot_be_indexed_is_named() {
  Table table = raster().plain;
  Words memory(path_index_size(table) / 4);
  const std::size_t size = 4 * memory.size();
  TEST_ASSERT_EQUAL(Result::buffer_too_small, index_path(memory.data(), size - 4, &table));
  TEST_ASSERT_EQUAL(Result::bad_argument, index_path(nullptr, size, &table));
  TEST_ASSERT_EQUAL(Result::bad_argument, index_path(memory.data(), size, nullptr));
  TEST_ASSERT_EQUAL(Result::bad_argument,
                    index_path(reinterpret_cast<unsigned char*>(memory.data()) + 1, size, &table));
  Table none;
  TEST_ASSERT_EQUAL(Result::bad_argument, index_path(memory.data(), size, &none));
  TEST_ASSERT_EQUAL(0, path_index_size(none));
  TEST_ASSERT_TRUE(table.index() == nullptr);
  Words far = test::raster_table({2, 6});
  const float huge = 1e30F;
  std::memcpy(far.data() + sizeof(TableHeader) / 4, &huge, sizeof huge);
  Table of_far = reopen(far);
  TEST_ASSERT_EQUAL(Result::table_corrupt, index_path(memory.data(), size, &of_far));
  TEST_ASSERT_TRUE(of_far.index() == nullptr);
}

void a_table_opened_again_has_no_index_until_it_gets_one() {
  Table table = raster().table;
  TEST_ASSERT_TRUE(table.index() != nullptr);
  TEST_ASSERT_EQUAL(Result::ok,
                    Table::reopen(raster().words.data(), 4 * raster().words.size(), &table));
  TEST_ASSERT_TRUE(table.index() == nullptr);
}

void a_grid_needs_none() {
  Words words(1 << 16);
  std::size_t size = 0;
  const GridRange<float> ranges[4] = {{-1.3F, -1.1F}, {1.2F, 1.4F}, {0.2F, 0.4F}, {0.7F, 0.9F}};
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_grid_table<float, 6>(kr270<float>(), ranges, {2000, 50, 1e-3F, 1e-3F, 0},
                                                words.data(), 4 * words.size(), &size)));
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), size, &table));
  TEST_ASSERT_EQUAL(0, path_index_size(table));
  TEST_ASSERT_EQUAL(Result::ok, index_path(nullptr, 0, &table));
  TEST_ASSERT_TRUE(table.index() == nullptr);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_jump_on_a_long_program_is_caught_up_with_in_five_look_ups);
  RUN_TEST(arming_finds_the_place_at_once);
  RUN_TEST(off_the_program_something_near_is_found);
  RUN_TEST(a_program_that_repeats_itself_is_found_too);
  RUN_TEST(programs_of_a_few_segments_have_an_index_too);
  RUN_TEST(following_the_program_needs_no_search);
  RUN_TEST(the_index_does_not_change_what_is_read);
  RUN_TEST(a_damaged_index_is_no_danger);
  RUN_TEST(however_far_off_the_search_ends);
  RUN_TEST(a_compensator_corrects_again_soon_after_a_jump);
  RUN_TEST(what_cannot_be_indexed_is_named);
  RUN_TEST(a_table_opened_again_has_no_index_until_it_gets_one);
  RUN_TEST(a_grid_needs_none);
  return UNITY_END();
}
