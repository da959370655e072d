#include <cstdlib>
#include <new>
#include <string>

#include "rsi/telegram.hpp"
#include "unity_main.hpp"

using namespace flexcomp;

namespace {

int allocations = 0;

const std::string kActual =
    "<AIPos A1=\"1.5\" A2=\"-90.25\" A3=\"90\" A4=\"-0.125\" A5=\"10\" A6=\"6\"/>";
const std::string kSetpoint =
    "<ASPos A1=\"2.5\" A2=\"-91.25\" A3=\"91\" A4=\"-1.125\" A5=\"11\" A6=\"7\"/>";
const std::string kIpoc = "<IPOC>4208163634</IPOC>";

std::string rob(const std::string& contents) { return "<Rob Type=\"KUKA\">" + contents + "</Rob>"; }

/// A whole telegram with more in it.
std::string rob_with(const std::string& more) { return rob(kActual + kSetpoint + kIpoc + more); }

std::string rob_with_arm(const std::string& text) { return rob_with("<Arm>" + text + "</Arm>"); }

const std::string kPlain = rob_with("");

RsiReading read(const std::string& text, const RsiSchema& schema = {}) {
  RsiTelegram telegram;
  telegram.ipoc = 77;
  const RsiReading result = read_telegram(text, schema, &telegram);
  TEST_ASSERT_TRUE((result == RsiReading::ok) == (telegram.ipoc != 77));  // untouched if refused
  return result;
}

RsiTelegram accepted(const std::string& text, const RsiSchema& schema = {}) {
  RsiTelegram telegram;
  TEST_ASSERT_EQUAL_STRING("ok", describe(read_telegram(text, schema, &telegram)));
  return telegram;
}

void positions_and_ipoc_are_read() {
  const RsiTelegram telegram = accepted(kPlain);
  const AxisAngles actual = {1.5, -90.25, 90, -0.125, 10, 6};
  const AxisAngles setpoint = {2.5, -91.25, 91, -1.125, 11, 7};
  TEST_ASSERT_EQUAL_DOUBLE_ARRAY(actual.data(), telegram.actual.data(), 6);
  TEST_ASSERT_EQUAL_DOUBLE_ARRAY(setpoint.data(), telegram.setpoint.data(), 6);
  TEST_ASSERT_TRUE(telegram.ipoc == 4208163634U);
  TEST_ASSERT_FALSE(telegram.late || telegram.wrench || telegram.armed);
}

/// As Python's xml.etree writes it, which is what public simulators of RSI use: with a blank before
/// the end of an empty element, TYPE in capitals, positions of the flange before those of the axes.
void a_telegram_of_the_ros_simulators_form_is_read() {
  const std::string pose = " X=\"0.0\" Y=\"0.0\" Z=\"0.0\" A=\"0.0\" B=\"0.0\" C=\"0.0\" />";
  const RsiTelegram telegram =
      accepted("<Rob TYPE=\"KUKA\"><RIst" + pose + "<RSol" + pose +
               "<AIPos A1=\"0.0\" A2=\"-90.0\" A3=\"90.0\" A4=\"0.0\" A5=\"90.0\" A6=\"0.0\" />"
               "<ASPos A1=\"0.0\" A2=\"-90.0\" A3=\"90.0\" A4=\"0.0\" A5=\"90.0\" A6=\"0.0\" />"
               "<Delay D=\"3\" /><IPOC>0</IPOC></Rob>");
  TEST_ASSERT_EQUAL_DOUBLE(-90, telegram.setpoint[1]);
  TEST_ASSERT_TRUE(telegram.late == 3U);
  TEST_ASSERT_TRUE(telegram.ipoc == 0);
}

/// A controller names its technology functions and digital signals too.
void elements_that_the_schema_does_not_name_are_passed_over() {
  const std::string others =
      "<Tech C11=\"0.0\" C12=\"0.0\" C13=\"0.0\" C14=\"0.0\" C15=\"0.0\" C16=\"0.0\" C17=\"0.0\" "
      "C18=\"0.0\" C19=\"0.0\" C110=\"0.0\"/><DiL>0</DiL><Digout o1=\"0\" o2=\"0\" o3=\"1\"/>"
      "<Source1>-13.2</Source1><EStr>no &lt;error&gt;</EStr><X><Y A1=\"9\">9</Y></X>";
  const RsiTelegram telegram =
      accepted(rob(others + kActual + others + kSetpoint + others + kIpoc));
  TEST_ASSERT_EQUAL_DOUBLE(1.5, telegram.actual[0]);
}

void blanks_line_ends_and_quotes_of_either_kind_do_not_matter() {
  accepted("\xEF\xBB\xBF<?xml version=\"1.0\" encoding=\"UTF-8\"?>\r\n<Rob Type='KUKA' >\r\n\t" +
           kActual +
           "\n<ASPos A1 = '1'\n A2='2' A3='3' A4='4' A5='5' A6='6' E1='7' >\n</ASPos >\n" +
           "<IPOC>\n 12 \n</IPOC>\n</Rob>\r\n");
  accepted(kPlain + std::string(3, '\0'));
}

void what_the_schema_names_is_read() {
  RsiSchema schema;
  schema.wrench = "FT";
  schema.armed = "Arm";
  schema.needs_late = true;
  const RsiTelegram telegram = accepted(rob(kActual + kSetpoint +
                                            "<Delay D=\"12\"/><Arm>1</Arm><FT Fx=\"1\" Fy=\"-2\" "
                                            "Fz=\"3.5\" Mx=\"4\" My=\"5\" Mz=\"6e1\"/>" +
                                            kIpoc),
                                        schema);
  const std::array<double, 6> wrench = {1, -2, 3.5, 4, 5, 60};
  TEST_ASSERT_EQUAL_DOUBLE_ARRAY(wrench.data(), telegram.wrench.value().data(), 6);
  TEST_ASSERT_TRUE(telegram.armed == true);
  TEST_ASSERT_TRUE(telegram.late == 12U);
}

void the_output_for_arming_is_a_number_or_a_word() {
  RsiSchema schema;
  schema.armed = "Arm";
  for (const char* on : {"1", "TRUE", "true", " 1 "}) {
    TEST_ASSERT_TRUE(accepted(rob_with_arm(on), schema).armed == true);
  }
  for (const char* off : {"0", "FALSE", "false"}) {
    TEST_ASSERT_TRUE(accepted(rob_with_arm(off), schema).armed == false);
  }
  for (const char* neither : {"", "2", "yes", "11", "1<x/>1"}) {
    TEST_ASSERT_EQUAL(RsiReading::no_number, read(rob_with_arm(neither), schema));
  }
}

void what_is_missing_is_told() {
  RsiSchema late;
  late.needs_late = true;
  RsiSchema wrench;
  wrench.wrench = "FT";
  RsiSchema armed;
  armed.armed = "Arm";
  for (const std::string& contents : {kActual + kSetpoint, kActual + kIpoc, kSetpoint + kIpoc,
                                      std::string(), kActual + kIpoc + "<ASPos A1=\"1\"/>"}) {
    TEST_ASSERT_EQUAL(RsiReading::missing, read(rob(contents)));
  }
  for (const RsiSchema& schema : {late, wrench, armed}) {
    TEST_ASSERT_EQUAL(RsiReading::missing, read(kPlain, schema));
  }
  TEST_ASSERT_EQUAL(RsiReading::missing,
                    read(rob(kActual + kSetpoint + "<FT Fx=\"1\"/>" + kIpoc), wrench));
  TEST_ASSERT_EQUAL(RsiReading::missing, read("<Rob/>"));
}

void what_is_there_twice_is_refused() {
  for (const std::string& again : {kActual, kSetpoint, kIpoc, std::string("<AIPos/>")}) {
    TEST_ASSERT_EQUAL(RsiReading::repeated, read(rob_with(again)));
  }
  TEST_ASSERT_EQUAL(RsiReading::repeated, read(rob("<AIPos A1=\"1\" A1=\"2\"/>")));
  TEST_ASSERT_EQUAL(RsiReading::repeated, read(rob("<Delay D=\"1\" D=\"1\"/>")));
}

void what_is_no_number_is_refused() {
  for (const char* text : {"nan", "inf", "", "1,5", "0x1", "1e999", "&#49;"}) {
    TEST_ASSERT_EQUAL(RsiReading::no_number,
                      read(rob("<AIPos A1=\"" + std::string(text) + "\"/>")));
  }
  for (const char* text : {"", "-1", "1.5", "99999999999999999999", "1<x/>2", "nan"}) {
    TEST_ASSERT_EQUAL(RsiReading::no_number, read(rob("<IPOC>" + std::string(text) + "</IPOC>")));
  }
  TEST_ASSERT_EQUAL(RsiReading::no_number, read(rob("<Delay D=\"-1\"/>")));
}

void a_telegram_that_ends_early_anywhere_is_refused() {
  for (std::size_t size = 0; size < kPlain.size(); ++size) {
    TEST_ASSERT_TRUE(read(kPlain.substr(0, size)) != RsiReading::ok);
  }
}

void what_is_not_well_formed_is_refused() {
  for (const std::string& text :
       {std::string("telegram"), kPlain + "x", kPlain + kPlain, "x" + kPlain, std::string("<"),
        rob_with("</X>"), rob("<AIPos A1=\"1\"A2=\"2\"/>"), rob("<AIPos A1=1/>"),
        rob("<AIPos A1/>"), rob("<AIPos A1=\"<\"/>"), rob("<AIPos></ASPos>"), rob("<!-- -->"),
        rob("<![CDATA[]]>"), "<!DOCTYPE Rob>" + kPlain, rob("< AIPos/>"), rob("<AIPos /"),
        std::string("<?xml"), std::string("<Rob></Rob"), std::string("</Rob>")}) {
    TEST_ASSERT_EQUAL_MESSAGE(RsiReading::no_xml, read(text), text.c_str());
  }
  TEST_ASSERT_EQUAL(RsiReading::no_rob, read("<Sen Type=\"ImFree\"></Sen>"));
}

void depth_and_length_are_bounded() {
  std::string deep;
  for (int i = 0; i < 100; ++i) {
    deep += "<x>";
  }
  TEST_ASSERT_EQUAL(RsiReading::too_deep, read(rob(deep)));
  const std::string longest =
      rob(kActual + kSetpoint + kIpoc + std::string(kLongestTelegram - kPlain.size(), ' '));
  TEST_ASSERT_EQUAL(RsiReading::ok, read(longest));
  TEST_ASSERT_EQUAL(RsiReading::too_long, read(longest + " "));
}

void every_result_has_words() {
  for (int i = 0; i <= static_cast<int>(RsiReading::no_number); ++i) {
    TEST_ASSERT_TRUE(std::string(describe(static_cast<RsiReading>(i))) != "unknown");
  }
}

void nothing_is_allocated() {
  RsiTelegram telegram;
  const std::string garbage = rob("<AIPos A1=\"nan\"/>");
  allocations = 0;
  read_telegram(kPlain, {}, &telegram);
  read_telegram(garbage, {}, &telegram);
  const int counted = allocations;
  TEST_ASSERT_EQUAL(0, counted);
  int* volatile seen = new int;  // a compiler may leave out what nobody sees
  delete seen;
  TEST_ASSERT_TRUE(allocations > 0);  // it would have been seen
}

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  void* memory = std::malloc(size);
  if (memory == nullptr) {
    std::abort();
  }
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

int main() {
  UNITY_BEGIN();
  RUN_TEST(positions_and_ipoc_are_read);
  RUN_TEST(a_telegram_of_the_ros_simulators_form_is_read);
  RUN_TEST(elements_that_the_schema_does_not_name_are_passed_over);
  RUN_TEST(blanks_line_ends_and_quotes_of_either_kind_do_not_matter);
  RUN_TEST(what_the_schema_names_is_read);
  RUN_TEST(the_output_for_arming_is_a_number_or_a_word);
  RUN_TEST(what_is_missing_is_told);
  RUN_TEST(what_is_there_twice_is_refused);
  RUN_TEST(what_is_no_number_is_refused);
  RUN_TEST(a_telegram_that_ends_early_anywhere_is_refused);
  RUN_TEST(what_is_not_well_formed_is_refused);
  RUN_TEST(depth_and_length_are_bounded);
  RUN_TEST(every_result_has_words);
  RUN_TEST(nothing_is_allocated);
  return UNITY_END();
}
