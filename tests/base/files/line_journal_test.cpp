// SPDX-License-Identifier: MIT
#include "base/files/line_journal.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace wholehand {
namespace {

// Numbers; what is none is of another run.
struct Reader {
  std::vector<int> parts;
  std::size_t damaged = 0;
  LineJournal::Take take = [this](const nlohmann::json& part) {
    if (!part.is_number_integer()) return false;
    parts.push_back(part.get<int>());
    return true;
  };
};

JournalKind kind_of(bool keeps_damaged) {
  return {"journal of a test ", "3", "this test was begun", "begin", "go on", "begin anew", keeps_damaged};
}

const JournalIdentity SEED_1{{"seed", "1"}};

// Three parts, of which the second is damaged, one that is no number, and a whole one without the end of its line.
std::string damaged_journal(const std::string& path, const JournalKind& kind) {
  {
    LineJournal journal(path, kind, SEED_1);
    for (const int part : {10, 20, 30}) journal.add(part);
    journal.add("none");
    journal.add(50);
  }
  std::string text = file_text(path);
  text[text.find(" 20\n") + 1] = '9';
  text.pop_back();
  write_file(path, text);
  return text;
}

TEST(LineJournal, GoesOnAfterDamagedLinesAndKeepsThem) {
  const TemporaryFolder folder;
  const std::string path = folder / "j", damaged = damaged_journal(path, kind_of(true));
  Reader first, second;
  LineJournal(path, kind_of(true), SEED_1, first.take, first.damaged).add(60);
  EXPECT_EQ(first.parts, (std::vector{10, 30, 50}));
  EXPECT_EQ(first.damaged, 2u);
  EXPECT_EQ(file_text(path).substr(0, damaged.size() + 1), damaged + "\n");
  LineJournal(path, kind_of(true), SEED_1, second.take, second.damaged);
  EXPECT_EQ(second.parts, (std::vector{10, 30, 50, 60}));
  EXPECT_EQ(second.damaged, 2u);
}

TEST(LineJournal, GoesOnWithoutDamagedLines) {
  const TemporaryFolder folder;
  const std::string path = folder / "j", whole = folder / "whole";
  damaged_journal(path, kind_of(false));
  Reader reader;
  LineJournal(path, kind_of(false), SEED_1, reader.take, reader.damaged).add(60);
  EXPECT_EQ(reader.parts, (std::vector{10, 30, 50}));
  EXPECT_EQ(reader.damaged, 2u);
  {
    LineJournal journal(whole, kind_of(false), SEED_1);
    for (const int part : {10, 30, 50, 60}) journal.add(part);
  }
  EXPECT_EQ(file_text(path), file_text(whole));
  EXPECT_FALSE(file_exists(path + ".new"));
}

TEST(LineJournal, RefusesAnotherRun) {
  const TemporaryFolder folder;
  const std::string path = folder / "j";
  const JournalKind kind = kind_of(false);
  LineJournal(path, kind, {{"scene", "a"}, {"seed", "1"}, {"size", "1"}});
  const std::string text = file_text(path);
  Reader reader;
  const auto refused = [&](const JournalKind& asked, const JournalIdentity& identity, ExitCode code) {
    return refusal_line([&] { LineJournal(path, asked, identity, reader.take, reader.damaged); }, code);
  };
  EXPECT_EQ(refused(kind, {{"scene", "b"}, {"seed", "1"}, {"size", "2"}}, ExitCode::usage),
            path + ": this test was begun with another scene, another size; ask for the same, or begin anew");
  JournalKind later = kind;
  later.format = "4";
  EXPECT_EQ(refused(later, {{"scene", "a"}, {"seed", "1"}, {"size", "1"}}, ExitCode::failure),
            path + ": is damaged, or of another version; begin anew");
  EXPECT_EQ(file_text(path), text) << "it stays as it was";
}

TEST(LineJournal, RefusesVersionsBefore04) {
  const TemporaryFolder folder;
  const std::string path = folder / "j";
  JournalKind kind = kind_of(false);
  LineJournal(path, kind, {{JOURNAL_BUILD, "0.3.0 1a2b"}});
  kind.format = "4";
  Reader reader;
  EXPECT_EQ(refusal_line([&] {
              LineJournal(path, kind, {{JOURNAL_BUILD, "0.4.0 3c4d"}}, reader.take, reader.damaged);
            }),
            path + ": written by version 0.3.0; this version reads files from 0.4.0 on: begin anew");
}

}  // namespace
}  // namespace wholehand
