#include "effects/laws/laws.hpp"

#include <algorithm>
#include <numeric>

namespace flexcomp::effects {
namespace {

/// To first order: the wrench on the tool changes by what the reading is off.
Term sensor_term(const SensorModel& truth, const Values& values) {
  return {Term::wrench, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            Eigen::MatrixXd change(at.wrench.rows(), 6);
            for (Eigen::Index row = 0; row < change.rows(); ++row) {
              const Matrix3<double>& tool = at.bent[static_cast<std::size_t>(row)].tcp.rotation;
              Wrench<double> read;
              read << tool.transpose() * at.wrench.row(row).head<3>().transpose(),
                  tool.transpose() * at.wrench.row(row).tail<3>().transpose();
              const Wrench<double> gap = truth(values, read) - read;
              change.row(row) << (tool * gap.head<3>()).transpose(),
                  (tool * gap.tail<3>()).transpose();
            }
            add_wrench(at, change, prediction);
          }};
}

/// Both ends included.
std::vector<int> from_to(int first, int last) {
  std::vector<int> all(static_cast<std::size_t>(std::max(last - first + 1, 0)));
  std::iota(all.begin(), all.end(), first);
  return all;
}

}  // namespace

std::function<std::vector<Parameter>(const model::Robot&, int)> constant(
    std::vector<Parameter> parameters) {
  return [parameters = std::move(parameters)](const model::Robot&, int) { return parameters; };
}

std::function<std::vector<Parameter>(const model::Robot&, int)> of_joint(
    std::vector<Parameter> parameters) {
  return [parameters = std::move(parameters)](const model::Robot& robot, int joint) {
    std::vector<Parameter> here = parameters;
    for (Parameter& each : here) {
      each.unit = model::unit_of(robot.elastic.joint(joint - 1), each.unit);
    }
    return here;
  };
}

std::function<std::vector<Parameter>(const model::Robot&, int)> wave_of_joint(
    const std::string& unit) {
  return [unit](const model::Robot& robot, int joint) {
    const model::ChainJoint& at = robot.elastic.joint(joint - 1);
    const std::string amplitude = model::unit_of(at, unit);
    return std::vector<Parameter>{
        {"sine", amplitude}, {"cosine", amplitude}, {"order", at.slides() ? "rad/m" : "1"}};
  };
}

std::function<std::vector<Derived>(const model::Robot&, int, const Values&)> whole_of(
    const std::string& name, const std::string& unit, double model::JointDynamics::*number) {
  return [name, unit, number](const model::Robot& robot, int joint, const Values& values) {
    const double known = robot.dynamics[index_of(joint)].*number;
    if (known == 0) {
      return std::vector<Derived>{};
    }
    const std::string here = model::unit_of(robot.elastic.joint(joint - 1), unit);
    return std::vector<Derived>{{name, here, known + values[0], 0}};
  };
}

std::function<std::string(int)> says(const char* clause) {
  return [clause](int joint) { return fmt::format(fmt::runtime(clause), joint); };
}

std::function<std::string(int)> says(const char* of_all, const char* of_one) {
  return [of_all, one = says(of_one)](int joint) {
    return joint == 0 ? std::string(of_all) : one(joint);
  };
}

void alter_robot(Alteration alteration, Law* law) {
  law->traits.alters_model = true;
  law->apply = [alteration = std::move(alteration)](const Values& values, int joint,
                                                    Machine* machine) {
    alteration(values, joint, &machine->robot);
  };
}

void alter_keys(Alteration alteration, Law* law) {
  law->write_keys = alteration;
  law->keys_say_all = true;
  alter_robot(std::move(alteration), law);
}

void add_term(std::function<Term(const Values&, int)> term, Law* law) {
  law->apply = [term = std::move(term)](const Values& values, int joint, Machine* machine) {
    machine->terms.push_back(term(values, joint));
  };
}

void alter_sensor(SensorModel truth, Law* law) {
  law->traits.alters_model = true;
  law->apply = [truth](const Values& values, int, Machine* machine) {
    machine->sensor.emplace_back([=](const Wrench<double>& read) { return truth(values, read); });
  };
  law->sketch = [truth](const Values& values, int) { return sensor_term(truth, values); };
}

std::vector<int> whole_machine(int /*joints*/) { return {0}; }

std::vector<int> every_joint(int joints) { return from_to(1, joints); }

std::vector<int> all_but_the_first(int joints) { return from_to(2, joints); }

std::vector<int> all_but_the_last(int joints) { return from_to(1, joints - 1); }

std::vector<int> machine_or_joint(int joints) { return from_to(0, joints); }

std::array<int, 2> axes_across(const Vector3<double>& direction) {
  int along = 0;
  direction.cwiseAbs().maxCoeff(&along);
  return {along == 0 ? 1 : 0, along == 2 ? 1 : 2};
}

std::array<int, 2> axes_across_joint(const model::Robot& robot, int joint) {
  return axes_across(robot.elastic.joints[index_of(joint)].axis);
}

std::vector<Parameter> of_axes(const std::array<int, 2>& axes, const std::string& prefix,
                               const std::string& unit) {
  std::vector<Parameter> parameters;
  for (const int axis : axes) {
    parameters.push_back({prefix + "xyz"[axis], unit});
  }
  return parameters;
}

}  // namespace flexcomp::effects
