#include "workbench/study/sweep_journal.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "study_support.hpp"

namespace waymark::study {
namespace {

using testing::HasSubstr;
using waymark::test::TempFolder;

SweepPlan journal_plan() { return test::quick_plan({{"seed", {"1", "2", "3"}}}); }

SweepRow journal_row(const std::string& seed, std::string error = "") {
  SweepRow made{{seed}, {}, std::move(error)};
  made.figures.fill(0.5);
  return made;
}

void write(const TempFolder& folder, std::initializer_list<SweepRow> rows) {
  auto journal = SweepJournal::open(journal_plan(), folder.path());
  ASSERT_TRUE(journal.ok()) << journal.error().message;
  for (const auto& one : rows) EXPECT_TRUE(journal->add(one).ok());
}

TEST(SweepJournal, KeepsWhatWasDoneAndForgetsWhatFailed) {
  const TempFolder folder;
  write(folder, {journal_row("1"), journal_row("2", "no luck")});
  write(folder, {journal_row("3")});
  const auto journal = SweepJournal::open(journal_plan(), folder.path());
  ASSERT_TRUE(journal.ok());
  ASSERT_EQ(journal->rows().size(), 2U);
  EXPECT_EQ(journal->rows()[0].point, SweepPoint{"1"});
  EXPECT_EQ(journal->rows()[1].point, SweepPoint{"3"});
}

TEST(SweepJournal, IsOnDiskAsSoonAsARowIsAdded) {
  const TempFolder folder;
  auto journal = SweepJournal::open(journal_plan(), folder.path());
  ASSERT_TRUE(journal.ok());
  ASSERT_TRUE(journal->add(journal_row("1")).ok());
  EXPECT_THAT(read_file(folder.path() / "journal.csv").value(),
              testing::EndsWith(to_csv(journal_row("1")) + "\n"));
}

TEST(SweepJournal, LosesAtMostTheRowThatWasCutWhereverItWas) {
  const TempFolder folder;
  write(folder, {journal_row("1"), journal_row("2")});
  const std::string whole = read_file(folder.path() / "journal.csv").value();
  const std::size_t head = whole.find("\n1,") + 1;
  const std::size_t second = whole.find("\n2,") + 1;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    folder.write("journal.csv", whole.substr(0, size));
    const auto journal = SweepJournal::open(journal_plan(), folder.path());
    ASSERT_TRUE(journal.ok()) << size << ": " << journal.error().message;
    const std::size_t expected = size == whole.size() ? 2 : size >= second ? 1 : 0;
    EXPECT_EQ(journal->rows().size(), expected) << size << " of " << whole.size() << ", head " << head;
  }
  write(folder, {journal_row("3")});
  EXPECT_EQ(SweepJournal::open(journal_plan(), folder.path())->rows().size(), 3U);
}

TEST(SweepJournal, OfAnotherSweepIsRefusedAndLeftAlone) {
  const TempFolder folder;
  write(folder, {journal_row("1")});
  const std::string before = read_file(folder.path() / "journal.csv").value();
  SweepPlan other = journal_plan();
  other.user.assignments.emplace_back("sim.laps=2");
  EXPECT_THAT(SweepJournal::open(other, folder.path()).error().message, HasSubstr("is of another sweep"));
  EXPECT_EQ(read_file(folder.path() / "journal.csv").value(), before);
  folder.write("journal.csv", "something of mine\n");
  EXPECT_THAT(SweepJournal::open(journal_plan(), folder.path()).error().message,
              HasSubstr("is of another sweep"));
}

TEST(SweepJournal, DamagedLineIsNamed) {
  const TempFolder folder;
  write(folder, {journal_row("1")});
  folder.write("journal.csv", read_file(folder.path() / "journal.csv").value() + "2,zero\n");
  EXPECT_THAT(SweepJournal::open(journal_plan(), folder.path()).error().message,
              HasSubstr("journal.csv:4: expected"));
}

}  // namespace
}  // namespace waymark::study
