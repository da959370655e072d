#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

// Eigen's decompositions of matrices of any size, compiled once for all who include this and link
// flexcomp_linear_algebra: in each other file a compiler takes up to six seconds for one of them.
// Without the header the same code gives the same results.
namespace Eigen {

extern template class JacobiSVD<MatrixXd>;
extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);

}  // namespace Eigen
