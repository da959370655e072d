#include "diagnosis/locate.hpp"

namespace flexcomp::diagnosis {

Location locate(const Observations&, const Eigen::VectorXd&) { return {}; }

}  // namespace flexcomp::diagnosis
