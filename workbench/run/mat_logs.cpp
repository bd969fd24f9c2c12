#include "workbench/run/mat_logs.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/names.hpp"

#include "workbench/run/choose_run.hpp"
#include "workbench/run/input_formats.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

bool is_mat_file(const fs::path& path) { return path.extension() == ".mat"; }

std::vector<fs::path> mat_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_mat_file(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// The log among the .mat files of a folder.
Result<fs::path> mat_log_in(const fs::path& folder, int run) {
  for (const MatFormat& format : mat_formats())
    if (!format.file.empty() && fs::exists(folder / format.file)) return folder / format.file;
  return choose_run(folder, mat_files(folder), run);
}

Error unknown_variables(const MatFile& file) {
  std::vector<std::string> formats;
  for (const MatFormat& format : mat_formats())
    formats.push_back(fmt::format("{} ({})", format.name, format.expects));
  return {fmt::format("{} is not a log: expected the variables of {}; found {}", file.path().string(),
                      one_of(formats), file.names().empty() ? "none" : file.names())};
}

Result<std::unique_ptr<Source>> open_mat_file(const fs::path& path, const InputOptions& options) {
  const auto file = MatFile::open(path);
  if (!file) return file.error();
  for (const MatFormat& format : mat_formats())
    if (format.recognises(*file)) return format.open(*file, options);
  return unknown_variables(*file);
}

}  // namespace

std::string mat_logs_expected() {
  std::vector<std::string> names;
  for (const MatFormat& format : mat_formats()) names.push_back(format.name);
  return "a .mat file of " + one_of(names);
}

bool is_mat_log(const fs::path& path) {
  return fs::is_directory(path) ? !mat_files(path).empty() : is_mat_file(path);
}

Result<std::unique_ptr<Source>> open_mat_log(const fs::path& path, const InputOptions& options) {
  if (!fs::is_directory(path)) return open_mat_file(path, options);
  const auto file = mat_log_in(path, options.run);
  return file ? open_mat_file(*file, options) : file.error();
}

}  // namespace waymark
