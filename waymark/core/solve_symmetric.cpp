#include "waymark/core/solve_symmetric.hpp"

#include <Eigen/Cholesky>

namespace waymark {

SmallMatrix solve_symmetric(const SmallMatrix& A, const SmallMatrix& B) { return A.ldlt().solve(B); }

}  // namespace waymark
