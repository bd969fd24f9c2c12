#include "workbench/datasets/mat_file.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <matio.h>

#include "workbench/datasets/mat_structure.hpp"
#include "workbench/logs/files.hpp"

namespace waymark {
namespace {

using MatHandle = std::unique_ptr<mat_t, decltype(&Mat_Close)>;
using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

bool is_plain_matrix(const matvar_t& variable) {
  return variable.rank == 2 && variable.class_type == MAT_C_DOUBLE && variable.data_type == MAT_T_DOUBLE &&
         variable.isComplex == 0 && variable.nbytes == variable.dims[0] * variable.dims[1] * sizeof(double) &&
         (variable.data != nullptr || variable.nbytes == 0);
}

/// Column by column, as MATLAB keeps it.
Eigen::MatrixXd values_of(const matvar_t& variable) {
  const auto rows = static_cast<Eigen::Index>(variable.dims[0]);
  const auto columns = static_cast<Eigen::Index>(variable.dims[1]);
  return Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(variable.data), rows, columns);
}

/// Null: it is no cell array.
matvar_t* const* cells_of(const matvar_t& variable) {
  const bool is_array = variable.class_type == MAT_C_CELL && variable.rank == 2 && variable.data != nullptr;
  return is_array ? static_cast<matvar_t* const*>(variable.data) : nullptr;
}

/// Nothing if one of them is no plain matrix.
std::optional<std::vector<Eigen::MatrixXd>> values_of(std::span<matvar_t* const> cells) {
  std::vector<Eigen::MatrixXd> values;
  values.reserve(cells.size());
  for (const matvar_t* cell : cells) {
    if (cell == nullptr || !is_plain_matrix(*cell)) return std::nullopt;
    values.push_back(values_of(*cell));
  }
  return values;
}

/// The first row with a value that is not finite, counted from 1; 0: there is none.
Eigen::Index first_bad_row(const Eigen::MatrixXd& values) {
  for (Eigen::Index row = 0; row < values.rows(); ++row)
    if (!values.row(row).allFinite()) return row + 1;
  return 0;
}

}  // namespace

Result<MatFile> MatFile::open(const std::filesystem::path& path) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  if (auto checked = check_mat_structure(*bytes, path.string()); !checked) return checked.error();
  const MatHandle file(Mat_Open(path.c_str(), MAT_ACC_RDONLY), &Mat_Close);
  if (!file) return Error{path.string() + ": is not a MATLAB file that can be read"};
  MatFile content;
  content.path_ = path;
  while (true) {
    const Variable variable(Mat_VarReadNext(file.get()), &Mat_VarFree);
    if (!variable) break;
    if (!content.add(*variable)) return Error{path.string() + ": damaged MATLAB file"};
  }
  return content;
}

bool MatFile::add(const matvar_t& variable) {
  if (variable.name == nullptr) return false;
  if (matvar_t* const* cells = cells_of(variable)) {
    auto values = values_of(std::span(cells, variable.dims[0] * variable.dims[1]));
    if (values) cells_.insert_or_assign(variable.name, *std::move(values));
    return values.has_value();
  }
  if (!is_plain_matrix(variable)) return false;
  variables_.insert_or_assign(variable.name, values_of(variable));
  return true;
}

bool MatFile::has_all(const std::vector<std::string_view>& variables) const {
  return std::ranges::all_of(variables, [this](std::string_view name) { return has(name); });
}

std::string MatFile::names() const {
  std::vector<std::string> names;
  for (const auto& [name, values] : variables_) names.push_back(name);
  for (const auto& [name, values] : cells_) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

Error MatFile::missing(std::string_view variable, std::string_view meaning) const {
  return {fmt::format("{}: variable {} ({}) is missing; it holds {}", path_.string(), variable, meaning,
                      names())};
}

const Eigen::MatrixXd* MatFile::find(std::string_view variable) const {
  const auto found = variables_.find(variable);
  return found == variables_.end() ? nullptr : &found->second;
}

Result<Eigen::MatrixXd> MatFile::matrix(std::string_view variable, Eigen::Index columns,
                                        std::string_view meaning) const {
  const Eigen::MatrixXd* values = find(variable);
  if (values == nullptr) return missing(variable, meaning);
  if (values->cols() != columns)
    return Error{fmt::format("{}: variable {} has {} columns; expected {} ({})", path_.string(), variable,
                             values->cols(), columns, meaning)};
  if (const auto row = first_bad_row(*values))
    return Error{fmt::format("{}: variable {}: row {} is not finite", path_.string(), variable, row)};
  return *values;
}

Result<Eigen::MatrixXd> MatFile::transposed(std::string_view variable, Eigen::Index rows,
                                            std::string_view meaning) const {
  const Eigen::MatrixXd* values = find(variable);
  if (values == nullptr) return missing(variable, meaning);
  if (values->rows() != rows)
    return Error{fmt::format("{}: variable {} has {} rows; expected {} ({})", path_.string(), variable,
                             values->rows(), rows, meaning)};
  const Eigen::MatrixXd upright = values->transpose();
  if (const auto column = first_bad_row(upright))
    return Error{fmt::format("{}: variable {}: column {} is not finite", path_.string(), variable, column)};
  return upright;
}

Result<Eigen::VectorXd> MatFile::vector(std::string_view variable, std::string_view meaning) const {
  const Eigen::MatrixXd* values = find(variable);
  const bool lies = values != nullptr && values->rows() == 1;
  const auto upright = lies ? transposed(variable, 1, meaning) : matrix(variable, 1, meaning);
  if (!upright) return upright.error();
  return Eigen::VectorXd(upright->col(0));
}

Result<std::vector<Eigen::MatrixXd>> MatFile::cells(std::string_view variable, Eigen::Index rows,
                                                    std::string_view meaning) const {
  const auto found = cells_.find(variable);
  if (found == cells_.end()) return missing(variable, meaning);
  for (std::size_t i = 0; i < found->second.size(); ++i) {
    const Eigen::MatrixXd& cell = found->second[i];
    if (cell.size() > 0 && (cell.rows() != rows || !cell.allFinite()))
      return Error{fmt::format("{}: variable {}: cell {} has {} rows; expected {} ({}), all finite",
                               path_.string(), variable, i + 1, cell.rows(), rows, meaning)};
  }
  return found->second;
}

}  // namespace waymark
