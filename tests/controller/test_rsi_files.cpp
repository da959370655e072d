#include <tinyxml.h>

#include <map>
#include <set>
#include <string>

#include "controller/rsi_files.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::controller::RsiProject;

namespace {

RsiProject project(RsiMode mode = RsiMode::absolute, bool has_force = true) {
  RsiProject project;
  project.robot = "KUKA KR 270";
  project.address = "192.168.1.10";
  project.port = 49152;
  project.type = "flexcomp_0123abcd";
  project.mode = mode;
  project.largest = 0.8;
  project.has_force = has_force;
  return project;
}

std::string file(const RsiProject& of, const std::string& name) {
  for (const auto& [each, contents] : rsi_files(of)) {
    if (each == name) {
      return contents;
    }
  }
  TEST_FAIL_MESSAGE(name.c_str());
  return "";
}

/// As a parser sees it that had no part in writing it.
TiXmlDocument parsed(const std::string& text) {
  TiXmlDocument document;
  document.Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  TEST_ASSERT_FALSE_MESSAGE(document.Error(), document.ErrorDesc());
  return document;
}

/// Tags of the elements sent or received, by their index.
std::map<std::string, std::string> elements(const TiXmlDocument& document, const char* direction) {
  std::map<std::string, std::string> all;
  const TiXmlElement* list =
      document.RootElement()->FirstChildElement(direction)->FirstChildElement("ELEMENTS");
  for (const TiXmlElement* each = list->FirstChildElement(); each != nullptr;
       each = each->NextSiblingElement()) {
    const std::string index = each->Attribute("INDX");
    all[index == "INTERNAL" ? each->Attribute("TAG") : index] = each->Attribute("TAG");
  }
  return all;
}

struct Wires {
  std::map<std::string, int> objects;  ///< type number by name
  std::map<std::string, std::string> inputs;
  std::map<std::string, std::string> parameters;
};

Wires wires(const TiXmlDocument& document) {
  Wires all;
  for (const TiXmlElement* object = document.RootElement()->FirstChildElement("RSIObject");
       object != nullptr; object = object->NextSiblingElement()) {
    const std::string name = object->Attribute("ObjID");
    all.objects[name] = static_cast<int>(std::strtol(object->Attribute("ObjTypeID"), nullptr, 10));
    for (const char* group : {"Inputs", "Parameters"}) {
      const TiXmlElement* list = object->FirstChildElement(group);
      for (const TiXmlElement* each = list == nullptr ? nullptr : list->FirstChildElement();
           each != nullptr; each = each->NextSiblingElement()) {
        if (group == std::string("Inputs")) {
          all.inputs[name + "." + each->Attribute("InIdx")] =
              std::string(each->Attribute("OutObjID")) + "." + each->Attribute("OutIdx");
        } else {
          all.parameters[name + "." + each->Attribute("Name")] = each->Attribute("ParamValue");
        }
      }
    }
  }
  return all;
}

void the_ethernet_file_names_computer_type_and_elements() {
  const TiXmlDocument document = parsed(file(project(), "flexcomp.xml"));
  const TiXmlElement* config = document.RootElement()->FirstChildElement("CONFIG");
  TEST_ASSERT_EQUAL_STRING("192.168.1.10", config->FirstChildElement("IP_NUMBER")->GetText());
  TEST_ASSERT_EQUAL_STRING("49152", config->FirstChildElement("PORT")->GetText());
  TEST_ASSERT_EQUAL_STRING("flexcomp_0123abcd", config->FirstChildElement("SENTYPE")->GetText());
  TEST_ASSERT_EQUAL_STRING("FALSE", config->FirstChildElement("ONLYSEND")->GetText());
  const auto sent = elements(document, "SEND");
  for (const char* internal : {"DEF_AIPos", "DEF_ASPos", "DEF_Delay"}) {
    TEST_ASSERT_EQUAL_MESSAGE(1, sent.count(internal), internal);
  }
  const auto received = elements(document, "RECEIVE");
  for (int i = 1; i <= 6; ++i) {
    TEST_ASSERT_EQUAL_STRING(("AK.A" + std::to_string(i)).c_str(),
                             received.at(std::to_string(i)).c_str());
  }
}

/// What is sent under an index is what is wired to that input; likewise what is received.
void elements_and_wires_agree() {
  const TiXmlDocument ethernet = parsed(file(project(), "flexcomp.xml"));
  const auto sent = elements(ethernet, "SEND");
  const auto received = elements(ethernet, "RECEIVE");
  const Wires context = wires(parsed(file(project(), "flexcomp.rsi.xml")));
  TEST_ASSERT_EQUAL_STRING("Arm", sent.at("1").c_str());
  TEST_ASSERT_EQUAL_STRING("SEN_PINT1.1", context.inputs.at("ETHERNET1.1").c_str());
  for (int i = 1; i <= 6; ++i) {
    const std::string axis = std::to_string(i);
    const std::string index = std::to_string(i + 1);
    TEST_ASSERT_EQUAL_STRING(("AxisCorrMon.A" + axis).c_str(), sent.at(index).c_str());
    TEST_ASSERT_EQUAL_STRING(("AXISCORRMON1." + axis).c_str(),
                             context.inputs.at("ETHERNET1." + index).c_str());
    TEST_ASSERT_EQUAL_STRING(("ETHERNET1." + axis).c_str(),
                             context.inputs.at("AXISCORR1." + axis).c_str());
  }
  TEST_ASSERT_EQUAL_STRING("State", received.at("7").c_str());
  TEST_ASSERT_EQUAL_STRING("ETHERNET1.7", context.inputs.at("MAP2SEN_PINT1.1").c_str());
  TEST_ASSERT_EQUAL_STRING("FT.Fx", sent.at("8").c_str());
  TEST_ASSERT_EQUAL_STRING("FT.Mz", sent.at("13").c_str());
}

/// Numbers of the object types as in public contexts.
void objects_have_their_numbers_and_limits() {
  const Wires context = wires(parsed(file(project(), "flexcomp.rsi.xml")));
  const std::map<std::string, int> expected = {{"AXISCORR1", 33},
                                               {"AXISCORRMON1", 82},
                                               {"ETHERNET1", 64},
                                               {"SEN_PINT1", 57},
                                               {"MAP2SEN_PINT1", 16}};
  TEST_ASSERT_TRUE(context.objects == expected);
  for (int i = 1; i <= 6; ++i) {
    const std::string axis = std::to_string(i);
    TEST_ASSERT_EQUAL_STRING("-0.8", context.parameters.at("AXISCORR1.LowerLimA" + axis).c_str());
    TEST_ASSERT_EQUAL_STRING("0.8", context.parameters.at("AXISCORR1.UpperLimA" + axis).c_str());
    TEST_ASSERT_EQUAL_STRING("1.2", context.parameters.at("AXISCORRMON1.MaxA" + axis).c_str());
  }
  TEST_ASSERT_EQUAL_STRING("flexcomp.xml", context.parameters.at("ETHERNET1.ConfigFile").c_str());
  TEST_ASSERT_EQUAL_STRING("100", context.parameters.at("ETHERNET1.Timeout").c_str());
  TEST_ASSERT_EQUAL_STRING("1", context.parameters.at("MAP2SEN_PINT1.Index").c_str());
  TEST_ASSERT_EQUAL_STRING("2", context.parameters.at("SEN_PINT1.Index").c_str());
}

void a_late_answer_holds_an_absolute_correction_and_adds_nothing_to_a_relative_one() {
  const std::string absolute = file(project(RsiMode::absolute), "flexcomp.xml");
  const std::string relative = file(project(RsiMode::relative), "flexcomp.xml");
  TEST_ASSERT_TRUE(absolute.find("\"AK.A1\" TYPE=\"DOUBLE\" INDX=\"1\" HOLDON=\"1\"") !=
                   std::string::npos);
  TEST_ASSERT_TRUE(relative.find("\"AK.A1\" TYPE=\"DOUBLE\" INDX=\"1\" HOLDON=\"0\"") !=
                   std::string::npos);
}

void the_program_starts_the_context_in_its_mode_and_cycle() {
  RsiProject slow = project(RsiMode::relative);
  slow.period = 0.012;
  const std::string absolute = file(project(), "flexcomp.src");
  const std::string relative = file(slow, "flexcomp.src");
  TEST_ASSERT_TRUE(absolute.find("RSI_CREATE(\"flexcomp.rsi\"") != std::string::npos);
  TEST_ASSERT_TRUE(absolute.find("RSI_ON(#ABSOLUTE, #IPO_FAST)") != std::string::npos);
  TEST_ASSERT_TRUE(relative.find("RSI_ON(#RELATIVE, #IPO)") != std::string::npos);
}

void no_force_is_sent_where_none_is_wired() {
  TEST_ASSERT_TRUE(file(project(RsiMode::absolute, false), "flexcomp.xml").find("FT.") ==
                   std::string::npos);
}

/// A line of a name would become a line of the program.
void a_name_cannot_add_to_program_or_comment() {
  RsiProject hostile = project();
  hostile.robot = "x\nPTP HOME\n--><evil/>";
  TEST_ASSERT_TRUE(file(hostile, "flexcomp.src").find("\nPTP HOME") == std::string::npos);
  const TiXmlDocument document = parsed(file(hostile, "flexcomp.xml"));
  TEST_ASSERT_TRUE(document.RootElement()->FirstChildElement("evil") == nullptr);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_ethernet_file_names_computer_type_and_elements);
  RUN_TEST(elements_and_wires_agree);
  RUN_TEST(objects_have_their_numbers_and_limits);
  RUN_TEST(a_late_answer_holds_an_absolute_correction_and_adds_nothing_to_a_relative_one);
  RUN_TEST(the_program_starts_the_context_in_its_mode_and_cycle);
  RUN_TEST(no_force_is_sent_where_none_is_wired);
  RUN_TEST(a_name_cannot_add_to_program_or_comment);
  return UNITY_END();
}
