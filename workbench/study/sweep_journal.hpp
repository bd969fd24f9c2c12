#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/study/sweep_figures.hpp"

namespace waymark::study {

/// What a sweep has done so far, on disk: a line is added for every finished run and handed to the system at
/// once, so that a program that is killed loses at most the runs that were under way. A last line that was
/// cut is dropped when the journal is opened again.
class SweepJournal {
 public:
  /// Opens or makes FOLDER/journal.csv. A journal of another sweep (input, settings, axes) is refused.
  [[nodiscard]] static Result<SweepJournal> open(const SweepPlan& plan, const std::filesystem::path& folder);

  /// The runs that were in it when it was opened; those that failed are to be made again and left out.
  [[nodiscard]] const std::vector<SweepRow>& rows() const { return rows_; }

  [[nodiscard]] Result<void> add(const SweepRow& row);

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::filesystem::path path_;
  std::vector<SweepRow> rows_;
  std::unique_ptr<std::FILE, CloseFile> file_;
};

/// Rows from lines below a csv_header(); `name` stands for the file in errors.
[[nodiscard]] Result<std::vector<SweepRow>> parse_rows(std::string text, const std::string& name,
                                                       const SweepPlan& plan);

}  // namespace waymark::study
