#include "controller/rsi_files.hpp"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

namespace flexcomp::controller {
namespace {

constexpr int kAxes = 6;
constexpr int kArmIndex = 1;      // inputs of ETHERNET1, which it sends
constexpr int kAppliedIndex = 2;  // to 7
constexpr int kForceIndex = 8;    // to 13
constexpr int kStateIndex = 7;    // outputs of ETHERNET1, after the corrections
constexpr const char* kForces[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};

constexpr const char* kForceHint =
    "  <!-- Wire inputs 8 to 13 of ETHERNET1 to the force sensor: force (N) and moment (N m) on "
    "the\n"
    "       tool at the TCP, in the frame of the robot's base. Until then they are zero. -->\n";

/// A name as a comment of XML and of KRL can hold it.
std::string plain(std::string name) {
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_letter = std::isalnum(static_cast<unsigned char>(name[i])) != 0;
    if (!is_letter && std::string_view(" ._()").find(name[i]) == std::string_view::npos) {
      name[i] = '_';
    }
  }
  return name;
}

std::string element(const std::string& tag, const char* type, int index, int hold) {
  const std::string held = hold < 0 ? "" : fmt::format(" HOLDON=\"{}\"", hold);
  return fmt::format("      <ELEMENT TAG=\"{}\" TYPE=\"{}\" INDX=\"{}\"{} />\n", tag, type, index,
                     held);
}

std::string internal(const char* name, const char* type) {
  return fmt::format("      <ELEMENT TAG=\"DEF_{}\" TYPE=\"{}\" INDX=\"INTERNAL\" />\n", name,
                     type);
}

std::string sent_elements(const RsiProject& project) {
  std::string text =
      internal("AIPos", "DOUBLE") + internal("ASPos", "DOUBLE") + internal("Delay", "LONG");
  text += element(kRsiArmed, "LONG", kArmIndex, -1);
  for (int i = 0; i < kAxes; ++i) {
    text += element(fmt::format("{}.A{}", kRsiApplied, i + 1), "DOUBLE", kAppliedIndex + i, -1);
  }
  for (int i = 0; project.has_force && i < kAxes; ++i) {
    text += element(fmt::format("{}.{}", kRsiWrench, kForces[i]), "DOUBLE", kForceIndex + i, -1);
  }
  return text;
}

/// An answer that is late leaves an absolute correction where it is, and adds nothing to a relative
/// one.
std::string received_elements(const RsiProject& project) {
  const int hold = project.mode == RsiMode::absolute ? 1 : 0;
  std::string text;
  for (int i = 0; i < kAxes; ++i) {
    text += element(fmt::format("AK.A{}", i + 1), "DOUBLE", i + 1, hold);
  }
  return text + element(kRsiState, "LONG", kStateIndex, 1);
}

std::string ethernet(const RsiProject& project) {
  return fmt::format(
      "<ROOT>\n"
      "  <!-- What {} and flexcompd say to each other each cycle. -->\n"
      "  <CONFIG>\n"
      "    <IP_NUMBER>{}</IP_NUMBER>\n"
      "    <PORT>{}</PORT>\n"
      "    <!-- flexcompd answers with this name, which is made from the robot's model: a node "
      "that\n"
      "         was set up for another robot is not obeyed. -->\n"
      "    <SENTYPE>{}</SENTYPE>\n"
      "    <ONLYSEND>FALSE</ONLYSEND>\n"
      "  </CONFIG>\n"
      "{}"
      "  <SEND>\n    <ELEMENTS>\n{}    </ELEMENTS>\n  </SEND>\n"
      "  <RECEIVE>\n    <ELEMENTS>\n{}    </ELEMENTS>\n  </RECEIVE>\n"
      "</ROOT>\n",
      plain(project.robot), project.address, project.port, project.type,
      project.has_force ? kForceHint : "", sent_elements(project), received_elements(project));
}

struct Parameter {
  std::string name;
  int number;
  std::string value;
};

std::string parameters(const std::vector<Parameter>& all) {
  std::string text = "    <Parameters>\n";
  for (const Parameter& each : all) {
    const char* fixed = each.name == "ConfigFile" ? " IsRuntime=\"false\"" : "";
    text += fmt::format("      <Parameter Name=\"{}\" ParamID=\"{}\" ParamValue=\"{}\"{} />\n",
                        each.name, each.number, each.value, fixed);
  }
  return text + "    </Parameters>\n";
}

/// Input `number`, fed by an output of another object.
std::string input(int number, const char* object, int output) {
  return fmt::format("      <Input InIdx=\"{}\" OutObjID=\"{}\" OutIdx=\"{}\" />\n", number, object,
                     output);
}

std::string inputs(const std::string& all) { return "    <Inputs>\n" + all + "    </Inputs>\n"; }

std::string object(const char* type, int number, const std::string& contents) {
  return fmt::format(
      "  <RSIObject ObjType=\"{0}\" ObjTypeID=\"{1}\" ObjID=\"{0}1\">\n{2}"
      "  </RSIObject>\n",
      type, number, contents);
}

std::string corrections(const RsiProject& project) {
  std::string wires;
  std::vector<Parameter> limits;
  for (int i = 1; i <= kAxes; ++i) {
    wires += input(i, "ETHERNET1", i);
  }
  for (int i = 1; i <= kAxes; ++i) {
    limits.push_back({fmt::format("LowerLimA{}", i), i, fmt::format("{:g}", -project.largest)});
  }
  constexpr int kFirstUpper = 13;
  for (int i = 1; i <= kAxes; ++i) {
    limits.push_back(
        {fmt::format("UpperLimA{}", i), kFirstUpper + i - 1, fmt::format("{:g}", project.largest)});
  }
  return object("AXISCORR", 33, inputs(wires) + parameters(limits));
}

/// Above the limit of the corrections, which are cut off there: what gets here is a fault.
std::string monitor(const RsiProject& project) {
  constexpr double kMargin = 1.5;
  std::vector<Parameter> limits;
  for (int i = 1; i <= kAxes; ++i) {
    limits.push_back({fmt::format("MaxA{}", i), i, fmt::format("{:g}", kMargin * project.largest)});
  }
  return object("AXISCORRMON", 82, parameters(limits));
}

std::string exchange() {
  std::string wires = input(kArmIndex, "SEN_PINT1", 1);
  for (int i = 0; i < kAxes; ++i) {
    wires += input(kAppliedIndex + i, "AXISCORRMON1", i + 1);
  }
  return object("ETHERNET", 64,
                inputs(wires) + parameters({{"ConfigFile", 1, "flexcomp.xml"},
                                            {"Timeout", 1, std::to_string(kRsiTolerated)},
                                            {"Flag", 4, "1"},
                                            {"Precision", 8, "4"}}));
}

std::string context(const RsiProject& project) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\"?>\n"
         "<RSIObjects xsi:noNamespaceSchemaLocation=\"/Roboter/Config/System/Common/Schemes/"
         "RSIContext.xsd\" xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\">\n" +
         object("SEN_PINT", 57, parameters({{"Index", 1, "2"}})) + corrections(project) +
         object("MAP2SEN_PINT", 16,
                inputs(input(1, "ETHERNET1", kStateIndex)) + parameters({{"Index", 1, "1"}})) +
         exchange() + monitor(project) + "</RSIObjects>\n";
}

std::string program(const RsiProject& project) {
  const char* mode = project.mode == RsiMode::absolute ? "#ABSOLUTE" : "#RELATIVE";
  constexpr double kFast = 0.008;  // s, between the two cycles that there are
  const char* cycle = project.period < kFast ? "#IPO_FAST" : "#IPO";
  return fmt::format(
      "&ACCESS RVP\n"
      "&REL 1\n"
      "DEF flexcomp( )\n"
      "; {} corrected by flexcompd over RSI.\n"
      "; Try it in T1, without a tool in the spindle, before anything else.\n"
      ";\n"
      "; $SEN_PINT[1]  state of the node: 0 off, 1 fading in, 2 active, 3 holding,\n"
      ";               4 fading out, 5 latched after a fault\n"
      "; $SEN_PINT[2]  1 asks for the correction, 0 gives it up\n"
      "; $FLAG[1]      TRUE: the node does not answer\n"
      "DECL INT ret\n"
      "DECL INT context\n"
      "DECL INT tries\n"
      "\n"
      ";FOLD INI\n"
      "BAS (#INITMOV,0)\n"
      ";ENDFOLD (INI)\n"
      "\n"
      "$SEN_PINT[1] = 0\n"
      "$SEN_PINT[2] = 0\n"
      "\n"
      "; Move to the beginning of the cut here, the tool clear of the part.\n"
      "PTP $AXIS_ACT\n"
      "\n"
      "ret = RSI_CREATE(\"flexcomp.rsi\", context, TRUE)\n"
      "IF (ret <> RSIOK) THEN\n"
      "  HALT\n"
      "ENDIF\n"
      "; {} corrections, each {:g} ms.\n"
      "ret = RSI_ON({}, {})\n"
      "IF (ret <> RSIOK) THEN\n"
      "  HALT\n"
      "ENDIF\n"
      "\n"
      "; The node has to see good telegrams for a while before it can be armed.\n"
      "WAIT SEC 0.5\n"
      "$SEN_PINT[2] = 1\n"
      "tries = 0\n"
      "WHILE ($SEN_PINT[1] <> 2) AND (tries < 50)\n"
      "  WAIT SEC 0.1\n"
      "  tries = tries + 1\n"
      "ENDWHILE\n"
      "IF ($SEN_PINT[1] <> 2) THEN\n"
      "  $SEN_PINT[2] = 0\n"
      "  HALT ; not armed: flexcompd says why\n"
      "ENDIF\n"
      "\n"
      "; The cut: ordinary motions with their own speed, such as\n"
      ";   LIN P1 C_DIS\n"
      ";   LIN P2 C_DIS\n"
      "; The node adds to them what the cutting force takes away. The path must be the one that "
      "its\n"
      "; table was made for.\n"
      "\n"
      "; Give the correction up with the tool clear of the part, before RSI is turned off: "
      "RSI_OFF\n"
      "; would drop it at once.\n"
      "$SEN_PINT[2] = 0\n"
      "WHILE ($SEN_PINT[1] <> 0) AND ($SEN_PINT[1] <> 5)\n"
      "  WAIT SEC 0.1\n"
      "ENDWHILE\n"
      "IF ($SEN_PINT[1] == 5) THEN\n"
      "  HALT ; a fault ended the correction during the cut\n"
      "ENDIF\n"
      "\n"
      "ret = RSI_OFF()\n"
      "IF (ret <> RSIOK) THEN\n"
      "  HALT\n"
      "ENDIF\n"
      "ret = RSI_DELETE(context)\n"
      "END\n",
      plain(project.robot), project.mode == RsiMode::absolute ? "Absolute" : "Relative",
      1e3 * project.period, mode, cycle);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> rsi_files(const RsiProject& project) {
  return {{"flexcomp.xml", ethernet(project)},
          {"flexcomp.rsi.xml", context(project)},
          {"flexcomp.src", program(project)}};
}

}  // namespace flexcomp::controller
