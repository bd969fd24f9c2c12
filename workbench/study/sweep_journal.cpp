#include "workbench/study/sweep_journal.hpp"

#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/files.hpp"
#include "workbench/logs/text_table.hpp"

namespace waymark::study {
namespace {

/// The first line: which sweep this is.
std::string title(std::uint64_t fingerprint) {
  return fmt::format("# waymark sweep 1 {:016x}\n", fingerprint);
}

/// The content up to the end of the last line that is whole.
std::string whole_lines(std::string text) {
  text.resize(text.rfind('\n') + 1);  // npos + 1 is 0
  return text;
}

SweepRow read_row(TextTable& table, std::size_t columns) {
  SweepRow row;
  for (std::size_t i = 0; i < columns; ++i) row.point.emplace_back(table.text(i));
  for (std::size_t i = 0; i < row.figures.size(); ++i)
    row.figures[i] =
        table.is_empty(columns + i) ? std::numeric_limits<double>::quiet_NaN() : table.number(columns + i);
  row.error = table.text(columns + row.figures.size());
  return row;
}

Error cannot_write(const std::filesystem::path& path) {
  return {"cannot write " + path.string(), Error::Kind::kFailed};
}

}  // namespace

Result<SweepJournal> SweepJournal::open(const SweepPlan& plan, const std::filesystem::path& folder) {
  const auto number = fingerprint(plan);
  if (!number) return number.error();
  SweepJournal journal;
  journal.path_ = folder / "journal.csv";
  std::string text;
  if (std::filesystem::exists(journal.path_)) {
    auto content = read_file(journal.path_);
    if (!content) return content.error();
    text = whole_lines(*std::move(content));
  }
  if (!text.empty() && !text.starts_with(title(*number)))
    return Error{
        fmt::format("{} is of another sweep (other input, settings or axes); choose another -o or remove it",
                    journal.path_.string())};
  const std::string head = title(*number) + csv_header(plan) + "\n";
  if (text.size() < head.size()) text = head;
  auto rows = parse_rows(text, journal.path_.string(), plan);
  if (!rows) return rows.error();
  journal.rows_ = *std::move(rows);
  std::erase_if(journal.rows_, [](const SweepRow& row) { return !row.error.empty(); });
  if (auto written = write_file(journal.path_, text); !written) return written.error();
  journal.file_.reset(std::fopen(journal.path_.c_str(), "ab"));
  if (!journal.file_) return cannot_write(journal.path_);
  return journal;
}

Result<std::vector<SweepRow>> parse_rows(std::string text, const std::string& name, const SweepPlan& plan) {
  auto table = TextTable::from(TextLines(std::move(text), name),
                               {csv_header(plan), TableLayout::Separator::kComma, ""});
  if (!table) return table.error();
  std::vector<SweepRow> rows;
  while (table->next()) rows.push_back(read_row(*table, columns(plan).size()));
  if (table->error()) return *table->error();
  return rows;
}

Result<void> SweepJournal::add(const SweepRow& row) {
  const std::string line = to_csv(row) + "\n";
  const bool written = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size();
  if (!written || std::fflush(file_.get()) != 0) return cannot_write(path_);
  return {};
}

}  // namespace waymark::study
