#include "workbench/run/choose_run.hpp"

#include <fmt/format.h>

namespace waymark {

Result<std::filesystem::path> choose_run(const std::filesystem::path& folder,
                                         const std::vector<std::filesystem::path>& runs, int run) {
  if (static_cast<std::size_t>(run) <= runs.size()) return runs[static_cast<std::size_t>(run) - 1];
  return Error{fmt::format("{}: no run {}; input.run can be 1 to {}", folder.string(), run, runs.size())};
}

}  // namespace waymark
