#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "core/test_robots.hpp"
#include "crc32.hpp"
#include "flexcomp/loop_gain.hpp"
#include "flexcomp/table_builder.hpp"
#include "table_record.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;
using flexcomp::test::loop_angles;

namespace {

using Model = RobotModel<double, 6>;
using Angles = JointVector<double, 6>;
using Words = std::vector<std::uint32_t>;

/// A process, and the gain that is safe with it: above a third, below one.
constexpr GainBasis kProcess{-0.0002F, 0.0012F, 0.002F, 0.004F, 60, 0.004F};
constexpr std::uint32_t kOneIn = FLEXCOMP_FEW_CASES ? 11 : 1;  // parts of a record
constexpr int kAngles = FLEXCOMP_FEW_CASES ? 300 : 3000;       // tried about the chords of a table
constexpr int kSteps = FLEXCOMP_FEW_CASES ? 15 : 40;           // of a program: a check takes all
constexpr double kTolerance = FLEXCOMP_FEW_CASES ? 4e-5 : 1e-5;  // m, rad
constexpr float kLastPlace = 1e-7F;  // m or rad: what a unit in the last place of an angle can do
constexpr std::size_t kHeaderWords = sizeof(TableHeader) / 4;
constexpr std::size_t kFirstNumber = offsetof(TableHeader, grid_lower) / 4;

/// A robot, a table of it, and setpoints that the table is for.
struct Subject {
  Model model;
  Words words;
  std::vector<Angles> setpoints;
};

Subject path_subject(const Model& model) {
  Subject subject{model, Words(1 << 16), {}};
  for (int i = 0; i <= kSteps; ++i) {
    subject.setpoints.push_back(loop_angles<double>(0.02 * i));
  }
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_path_table<double, 6>(
                        model, subject.setpoints.data(), subject.setpoints.size(),
                        {1600, 20, kTolerance, kTolerance, gain_limit(kProcess).safe, kProcess},
                        subject.words.data(), 4 << 16, &size)));
  subject.words.resize(size / 4);
  return subject;
}

Subject grid_subject() {
  Subject subject{kr270<double>(), Words(1 << 16), {}};
  const GridRange<double> ranges[4] = {{-1.25, -1.15}, {1.25, 1.35}, {0.3, 0.3}, {0.8, 0.8}};
  for (int i = 0; i <= kSteps; ++i) {
    Angles q;
    q << 0.3 + 0.01 * i, -1.25 + 0.0025 * i, 1.35 - 0.0025 * i, 0.3, 0.8, 0.02 * i;
    subject.setpoints.push_back(q);
  }
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::ok, (build_grid_table<double, 6>(
                                    subject.model, ranges, {1600, 20, kTolerance, kTolerance},
                                    subject.words.data(), 4 << 16, &size)));
  subject.words.resize(size / 4);
  return subject;
}

void make_crc(Words* words) {
  (*words)[offsetof(TableHeader, crc) / 4] = 0;
  (*words)[offsetof(TableHeader, crc) / 4] = crc32(words->data(), 4 * words->size());
}

bool is_refused(const Model& model, const Words& words) {
  Table table;
  if (Table::open(words.data(), 4 * words.size(), &table) != Result::ok) {
    return true;
  }
  TableError<double> error;
  if (derive_certificate(model, table, &error) != Result::ok ||
      !(error.position <= static_cast<double>(table.header().position_error) &&
        error.orientation <= static_cast<double>(table.header().orientation_error))) {
    return true;
  }
  if (table.chart() == Chart::joint_grid) {
    return false;
  }
  const InsideError inside = inside_error(table.header());
  return derive_inside_error(model, table, &error) != Result::ok ||
         !(error.position <= static_cast<double>(inside.position) &&
           error.orientation <= static_cast<double>(inside.orientation));
}

/// All that a controller takes from the table: its largest gain, and a tick's deflections,
/// corrections and distances outside at all setpoints.
std::vector<float> responses(const Words& words, const std::vector<Angles>& setpoints) {
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  Wrench<float> wrench;
  wrench << 440, 1370, 635, 1, 3, 10.5F;
  std::vector<float> all{table.header().largest_gain};
  TableCursor cursor;
  locate<float, 6>(table, setpoints.front().cast<float>(), &cursor);
  for (const Angles& q : setpoints) {
    float outside = 0;
    const auto response =
        look_up_response<float, 6>(table, q.cast<float>(), wrench, &cursor, &outside);
    for (Eigen::Index i = 0; i < 6; ++i) {
      all.push_back(response.deflection[i]);
      all.push_back(response.correction[i]);
    }
    all.push_back(outside);
  }
  return all;
}

std::uint32_t bits_of(float number) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return bits;
}

std::vector<std::uint32_t> lies_about(std::uint32_t word, bool is_number) {
  if (!is_number) {
    return {0, 1, 2, 3, word + 1, word - 1, 5 * word, word ^ 0x80000000U, 0xFFFFFFFFU};
  }
  float number = 0;
  std::memcpy(&number, &word, sizeof number);
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<std::uint32_t> lies;
  for (const float lie :
       {-number, 5 * number, 0.2F * number, 0.0F, 1.0F, 1e30F, -1e30F, 1e-40F, -1e-40F, infinity,
        std::nanf(""), std::nextafter(number, infinity), std::nextafter(number, -infinity)}) {
    lies.push_back(bits_of(lie));
  }
  return lies;
}

/// The lie about word `at`, with its CRC made anew, is refused or changes a tick (m or rad) by no
/// more than `most`.
void assert_found_or_harmless(const Subject& subject, std::size_t at, std::uint32_t lie,
                              const std::vector<float>& truth, float most, const char* what) {
  Words words = subject.words;
  if (words[at] == lie) {
    return;
  }
  words[at] = lie;
  make_crc(&words);
  if (is_refused(subject.model, words)) {
    return;
  }
  const std::vector<float> told = responses(words, subject.setpoints);
  float largest = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    largest = std::max(largest, std::abs(told[i] - truth[i]));
  }
  if (!(largest <= most)) {
    const std::string message = std::string(what) + ": word " + std::to_string(at) + " as " +
                                std::to_string(lie) + " changes a tick by " +
                                std::to_string(1e9 * static_cast<double>(largest)) + "e-9";
    TEST_FAIL_MESSAGE(message.c_str());
  }
}

/// A grid states no process; `flexcomp table verify` is told it.
bool is_largest_gain(std::size_t at) { return at == offsetof(TableHeader, largest_gain) / 4; }

void try_all_header_fields(const Subject& subject, const char* what) {
  TEST_ASSERT_FALSE_MESSAGE(is_refused(subject.model, subject.words), what);
  const std::vector<float> truth = responses(subject.words, subject.setpoints);
  const bool is_grid = subject.words[offsetof(TableHeader, grid_axes) / 4] > 0;
  for (std::size_t at = 0; at < kHeaderWords; ++at) {
    if (is_grid && is_largest_gain(at)) {
      continue;
    }
    for (const std::uint32_t lie : lies_about(subject.words[at], at >= kFirstNumber)) {
      assert_found_or_harmless(subject, at, lie, truth, kLastPlace, what);
    }
  }
}

void every_header_field_that_lies_is_refused_or_changes_nothing() {
  try_all_header_fields(path_subject(kr270<double>()), "path");
  try_all_header_fields(path_subject(kr270_with_everything<double>()), "path with everything");
  try_all_header_fields(grid_subject(), "grid");
}

void springs_limits_and_bounds_that_lie_are_refused() {
  const Subject subject = path_subject(kr270_with_everything<double>());
  for (std::size_t at = offsetof(TableHeader, joint_lower) / 4; at < kHeaderWords; ++at) {
    const bool is_bound = at >= offsetof(TableHeader, force_bound) / 4;
    for (const float factor : {-1.0F, 5.0F, 1e30F}) {
      // A bound that is a few times larger may hold too.
      if (is_bound && factor == 5.0F && !is_largest_gain(at)) {
        continue;
      }
      Words words = subject.words;
      float number = 0;
      std::memcpy(&number, &words[at], sizeof number);
      words[at] = bits_of(factor * number);
      make_crc(&words);
      TEST_ASSERT_TRUE_MESSAGE(is_refused(subject.model, words), std::to_string(at).c_str());
    }
  }
}

void every_part_of_a_record_that_lies_is_refused_or_within_the_certificate() {
  for (const Model& model : {kr270<double>(), kr270_with_everything<double>()}) {
    const Subject subject = path_subject(model);
    Table table;
    TEST_ASSERT_EQUAL(Result::ok,
                      Table::open(subject.words.data(), 4 * subject.words.size(), &table));
    const std::vector<float> truth = responses(subject.words, subject.setpoints);
    const RecordLayout layout = record_layout(table);
    for (const std::uint32_t node :
         {std::uint32_t{0}, std::uint32_t{1}, table.header().node_count - 1}) {
      for (std::uint32_t i = node % kOneIn; i < layout.size; i += kOneIn) {
        const std::size_t at = kHeaderWords + std::size_t{node} * layout.size + i;
        float number = 0;
        std::memcpy(&number, &subject.words[at], sizeof number);
        for (const float lie : {-number, 5 * number, 0.0F, number + 1, 1e30F, 1e-40F}) {
          // A smaller width makes the table end sooner, which a tick meets by correcting less.
          if (i == layout.width && lie < number) {
            continue;
          }
          // An error that the certificate allows is no lie: a newton metre of a weight's torque,
          // say.
          assert_found_or_harmless(subject, at, bits_of(lie), truth, table.header().position_error,
                                   "record");
        }
      }
    }
  }
}

/// All planes of a path table leaned over by up to `tilt`, its widths multiplied.
Words with_planes_and_widths(const Subject& subject, double tilt, float wider,
                             std::mt19937* random) {
  std::normal_distribution<double> normal;
  Words words = subject.words;
  auto* const header = reinterpret_cast<TableHeader*>(words.data());
  const RecordLayout layout = record_layout(Chart::path, (header->contents & Table::kWeight) != 0,
                                            (header->contents & Table::kStructure) != 0);
  for (std::uint32_t node = 0; node < header->node_count; ++node) {
    auto* const record = reinterpret_cast<float*>(words.data()) + kHeaderWords + node * layout.size;
    Angles lean;
    for (Eigen::Index i = 0; i < 6; ++i) {
      lean[i] = normal(*random);
    }
    const Angles plane =
        Eigen::Map<const Eigen::Matrix<float, 6, 1>>(record + layout.normal_in).cast<double>();
    const Angles leaned = (plane + std::tan(tilt) * lean.normalized()).normalized();
    for (const std::uint32_t part : {layout.switching, layout.normal_in, layout.normal_out}) {
      for (Eigen::Index i = 0; i < 6; ++i) {
        record[part + static_cast<std::uint32_t>(i)] = static_cast<float>(leaned[i]);
      }
    }
    record[layout.width] *= wider;
  }
  make_crc(&words);
  return words;
}

/// The error at angles about the chords, as far as a lookup takes them for inside, is as stated.
/// Returns how many it took.
int assert_no_angle_inside_is_off_by_more_than_stated(const Subject& subject, const Words& words,
                                                      std::mt19937* random) {
  Table table;
  TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), 4 * words.size(), &table));
  const InsideError stated = inside_error(table.header());
  const RecordLayout layout = record_layout(table);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int inside = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double place[kMaxGridAxes] = {std::abs(uniform(*random))};
    const auto segment = static_cast<std::uint32_t>(place[0] * (table.header().node_count - 1));
    const double width = static_cast<double>(table.record(segment)[layout.width]);
    Angles q = chart_angles<double, 6>(table, place);
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      q[joint] += width * std::clamp(2 * uniform(*random), -1.0, 1.0);
    }
    TableCursor cursor;
    locate<double, 6>(table, q, &cursor);
    TableCursor again = cursor;
    if (look_up<double, 6>(table, q, &again).outside > 0) {
      continue;
    }
    const auto error = table_error_at<double, 6>(subject.model, table, q, &cursor);
    TEST_ASSERT_TRUE(error.position <= static_cast<double>(stated.position));
    TEST_ASSERT_TRUE(error.orientation <= static_cast<double>(stated.orientation));
    ++inside;
  }
  return inside;
}

void no_angle_inside_is_off_by_more_than_stated_whatever_the_planes_say() {
  std::mt19937 random(3);
  for (const Model& model : {kr270<double>(), kr270_with_everything<double>()}) {
    const Subject subject = path_subject(model);
    int inside = 0;
    for (const double tilt : {0.0, 0.02, 0.3, 0.75}) {
      const Words words = with_planes_and_widths(subject, tilt, 1, &random);
      TEST_ASSERT_TRUE(tilt > 0.02 || !is_refused(model, words));
      inside += assert_no_angle_inside_is_off_by_more_than_stated(subject, words, &random);
    }
    TEST_ASSERT_TRUE(inside > kAngles / 6);
  }
}

void widths_that_take_in_more_than_is_stated_are_refused() {
  std::mt19937 random(4);
  for (const Model& model : {kr270<double>(), kr270_with_everything<double>()}) {
    const Subject subject = path_subject(model);
    for (const float wider : {1.2F, 2.0F, 20.0F}) {
      TEST_ASSERT_TRUE(is_refused(model, with_planes_and_widths(subject, 0, wider, &random)));
    }
    TEST_ASSERT_FALSE(is_refused(model, with_planes_and_widths(subject, 0, 1, &random)));
  }
}

void a_table_that_states_nothing_for_angles_off_the_program_is_an_older_one() {
  Subject subject = path_subject(kr270<double>());
  auto* const header = reinterpret_cast<TableHeader*>(subject.words.data());
  set_inside_error({}, header);
  set_gain_basis({}, header);
  make_crc(&subject.words);
  Table table;
  TEST_ASSERT_EQUAL(Result::ok,
                    Table::open(subject.words.data(), 4 * subject.words.size(), &table));
  TableError<double> error;
  TEST_ASSERT_EQUAL(Result::ok, derive_certificate(subject.model, table, &error));
  TEST_ASSERT_TRUE(error.position <= static_cast<double>(table.header().position_error));
  TEST_ASSERT_EQUAL(Result::ok, derive_inside_error(subject.model, table, &error));
  TEST_ASSERT_TRUE(error.position > 0);
}

void tables_of_either_precision_are_found_true() {
  const Model model = kr270<double>();
  for (const double step : {0.02, 0.3, 1.0}) {
    std::vector<JointVector<float, 6>> program;
    for (int i = 0; i <= 12; ++i) {
      program.push_back(loop_angles<float>(step * i));
    }
    Words words(1 << 16);
    std::size_t size = 0;
    TEST_ASSERT_EQUAL(Result::ok, (build_path_table<float, 6>(
                                      kr270<float>(), program.data(), program.size(),
                                      {1600, 20, 1e-5F, 1e-5F, 0}, words.data(), 4 << 16, &size)));
    words.resize(size / 4);
    TEST_ASSERT_FALSE(is_refused(model, words));
  }
}

void a_table_of_a_robot_that_gives_nowhere_is_exact() {
  Model model = kr270<double>();
  for (auto& joint : model.joints) {
    joint.compliance = 0;
  }
  const Subject subject = path_subject(model);
  TEST_ASSERT_FALSE(is_refused(model, subject.words));
  TEST_ASSERT_TRUE(is_refused(kr270<double>(), subject.words));
}

void a_table_of_another_robot_is_refused_whatever_its_fingerprint() {
  const Subject subject = path_subject(kr270<double>());
  Model other = kr270<double>();
  other.joints[2].origin.position.x() += 0.01;
  Words words = subject.words;
  const std::uint64_t hash = model_hash(other);
  words[offsetof(TableHeader, model_hash_low) / 4] = static_cast<std::uint32_t>(hash);
  words[offsetof(TableHeader, model_hash_high) / 4] = static_cast<std::uint32_t>(hash >> 32);
  make_crc(&words);
  TEST_ASSERT_TRUE(is_refused(other, words));
  TEST_ASSERT_TRUE(is_refused(subject.model, words));
}

void what_is_no_table_or_no_model_is_refused() {
  Subject subject = path_subject(kr270<double>());
  Table table;
  TEST_ASSERT_EQUAL(Result::bad_argument, check_against_model(subject.model, table));
  TEST_ASSERT_EQUAL(Result::ok,
                    Table::open(subject.words.data(), 4 * subject.words.size(), &table));
  TEST_ASSERT_EQUAL(Result::ok, check_against_model(subject.model, table));
  subject.model.joints[0].compliance = std::nan("");
  TEST_ASSERT_EQUAL(Result::bad_model, check_against_model(subject.model, table));
  TEST_ASSERT_EQUAL(Result::table_other_model,
                    check_against_model(kr270_with_everything<double>(), table));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(every_header_field_that_lies_is_refused_or_changes_nothing);
  RUN_TEST(springs_limits_and_bounds_that_lie_are_refused);
  RUN_TEST(every_part_of_a_record_that_lies_is_refused_or_within_the_certificate);
  RUN_TEST(no_angle_inside_is_off_by_more_than_stated_whatever_the_planes_say);
  RUN_TEST(widths_that_take_in_more_than_is_stated_are_refused);
  RUN_TEST(a_table_that_states_nothing_for_angles_off_the_program_is_an_older_one);
  RUN_TEST(tables_of_either_precision_are_found_true);
  RUN_TEST(a_table_of_a_robot_that_gives_nowhere_is_exact);
  RUN_TEST(a_table_of_another_robot_is_refused_whatever_its_fingerprint);
  RUN_TEST(what_is_no_table_or_no_model_is_refused);
  return UNITY_END();
}
