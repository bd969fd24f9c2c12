#include "waymark/io/mat_file.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>

#include "waymark/io/files.hpp"
#include "waymark/io/mat_structure.hpp"

namespace waymark {
namespace {

using File = std::unique_ptr<mat_t, decltype(&Mat_Close)>;
using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

bool is_plain_matrix(const matvar_t& variable) {
  return variable.name != nullptr && variable.rank == 2 && variable.class_type == MAT_C_DOUBLE &&
         variable.data_type == MAT_T_DOUBLE && variable.isComplex == 0 &&
         variable.nbytes == variable.dims[0] * variable.dims[1] * sizeof(double) &&
         (variable.data != nullptr || variable.nbytes == 0);
}

/// Column by column, as MATLAB keeps it.
Eigen::MatrixXd values_of(const matvar_t& variable) {
  const auto rows = static_cast<Eigen::Index>(variable.dims[0]);
  const auto columns = static_cast<Eigen::Index>(variable.dims[1]);
  return Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(variable.data), rows, columns);
}

}  // namespace

Result<MatFile> MatFile::open(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  if (auto checked = check_mat_structure(*bytes, path.string()); !checked) return checked.error();
  const File file(Mat_Open(path.c_str(), MAT_ACC_RDONLY), &Mat_Close);
  if (!file) return Error{path.string() + ": is no MATLAB file that can be read"};
  MatFile content;
  content.path_ = path;
  while (true) {
    const Variable variable(Mat_VarReadNext(file.get()), &Mat_VarFree);
    if (!variable) break;
    if (!is_plain_matrix(*variable)) return Error{path.string() + ": damaged MATLAB file"};
    content.variables_.insert_or_assign(variable->name, values_of(*variable));
  }
  return content;
}

bool MatFile::has_all(const std::vector<std::string_view>& variables) const {
  return std::ranges::all_of(variables, [this](std::string_view name) { return has(name); });
}

std::string MatFile::names() const {
  std::vector<std::string> names;
  for (const auto& [name, values] : variables_) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

Result<Eigen::MatrixXd> MatFile::matrix(std::string_view variable, Eigen::Index columns,
                                        std::string_view meaning) const {
  const auto found = variables_.find(variable);
  if (found == variables_.end())
    return Error{fmt::format("{}: variable {} ({}) is missing; it holds {}", path_.string(), variable,
                             meaning, names())};
  const Eigen::MatrixXd& values = found->second;
  if (values.cols() != columns)
    return Error{fmt::format("{}: variable {} has {} columns; expected {} ({})", path_.string(), variable,
                             values.cols(), columns, meaning)};
  for (Eigen::Index row = 0; row < values.rows(); ++row)
    if (!values.row(row).allFinite())
      return Error{fmt::format("{}: variable {}: row {} is not finite", path_.string(), variable, row + 1)};
  return values;
}

}  // namespace waymark
