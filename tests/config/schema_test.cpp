#include "workbench/config/schema.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

enum class Colour { kRed, kGreen, kBlue };

/// One key of every type.
struct Options {
  double probability = 0.99;
  double offset_m = -0.25;
  int particles = 100;
  std::uint64_t seed = 1;
  bool verbose = false;
  std::string name = "first run";
  Colour colour = Colour::kGreen;
};

bool operator==(const Options& a, const Options& b) {
  return a.probability == b.probability && a.offset_m == b.offset_m && a.particles == b.particles &&
         a.seed == b.seed && a.verbose == b.verbose && a.name == b.name && a.colour == b.colour;
}

void describe(Schema& schema, Options& o) {
  schema.real("gate.probability", o.probability, {0.5, 1.0}, "part of the true observations that may pass");
  schema.real("camera.x_m", o.offset_m, {}, "camera ahead of the robot's origin, m");
  schema.integer("filter.particles", o.particles, {1, 10000}, "number of particles");
  schema.integer("seed", o.seed, {0}, "seed of all random numbers");
  schema.boolean("gate.verbose", o.verbose, "tell what was refused");
  schema.text("run.name", o.name, "title of the report");
  schema.choice("run.colour", o.colour, {"red", "green", "blue"}, "colour of the path");
}

class ConfigTest : public testing::Test {
 protected:
  ConfigTest() { describe(schema_, options_); }

  std::string error_of(const std::string& key, const std::string& value) {
    const auto result = schema_.set(key, value, "here");
    return result.ok() ? "" : result.error().message;
  }
  std::string load_error(const std::string& yaml) {
    const auto result = schema_.load_text(yaml, "robot.yaml");
    return result.ok() ? "" : result.error().message;
  }

  Options options_;
  Schema schema_;
};

TEST_F(ConfigTest, SetsEveryType) {
  EXPECT_EQ(error_of("gate.probability", "0.75"), "");
  EXPECT_EQ(error_of("camera.x_m", "-1.5e-3"), "");
  EXPECT_EQ(error_of("filter.particles", "7"), "");
  EXPECT_EQ(error_of("seed", "18446744073709551615"), "");
  EXPECT_EQ(error_of("gate.verbose", "true"), "");
  EXPECT_EQ(error_of("run.name", "second = last"), "");
  EXPECT_EQ(error_of("run.colour", "blue"), "");
  EXPECT_EQ(options_,
            (Options{0.75, -1.5e-3, 7, 18446744073709551615U, true, "second = last", Colour::kBlue}));
}

TEST_F(ConfigTest, TellsTheValueInForce) {
  EXPECT_EQ(schema_.value("gate.probability"), "0.99");
  EXPECT_EQ(schema_.value("run.colour"), "green");
  EXPECT_EQ(schema_.value("gate.verbose"), "false");
  ASSERT_TRUE(schema_.set("filter.particles", "12", "here").ok());
  EXPECT_EQ(schema_.value("filter.particles"), "12");
}

TEST_F(ConfigTest, KnowsWhatWasSetBeItToItsDefault) {
  EXPECT_FALSE(schema_.was_set("filter.particles"));
  EXPECT_NE(error_of("filter.particles", "many"), "");
  EXPECT_FALSE(schema_.was_set("filter.particles"));
  EXPECT_EQ(error_of("filter.particles", schema_.value("filter.particles")), "");
  EXPECT_TRUE(schema_.was_set("filter.particles"));
  EXPECT_FALSE(schema_.was_set("no.such.key"));
}

TEST_F(ConfigTest, KnowsItsKeysInOrder) {
  EXPECT_TRUE(schema_.has("run.colour"));
  EXPECT_FALSE(schema_.has("colour"));
  EXPECT_THAT(schema_.keys(), testing::ElementsAre("gate.probability", "camera.x_m", "filter.particles",
                                                   "seed", "gate.verbose", "run.name", "run.colour"));
}

TEST_F(ConfigTest, TakesLimitsThemselvesAndRefusesWhatIsBeyond) {
  EXPECT_EQ(error_of("gate.probability", "0.5"), "");
  EXPECT_EQ(error_of("gate.probability", "1"), "");
  EXPECT_EQ(error_of("gate.probability", "1.0001"),
            "here: gate.probability cannot be '1.0001'; allowed: a number, 0.5 to 1");
  EXPECT_EQ(error_of("filter.particles", "0"),
            "here: filter.particles cannot be '0'; allowed: whole number, 1 to 10000");
  EXPECT_EQ(error_of("seed", "-1"), "here: seed cannot be '-1'; allowed: whole number, at least 0");
  EXPECT_EQ(options_.probability, 1.0) << "a refused value changes nothing";
}

TEST_F(ConfigTest, TellsTheLimitsOfRealNumbers) {
  ASSERT_TRUE(schema_.limits("gate.probability").has_value());
  EXPECT_EQ(schema_.limits("gate.probability")->low, 0.5);
  EXPECT_EQ(schema_.limits("gate.probability")->high, 1.0);
  for (const char* other :
       {"filter.particles", "seed", "gate.verbose", "run.name", "run.colour", "no.such.key"})
    EXPECT_FALSE(schema_.limits(other).has_value()) << other;
}

TEST_F(ConfigTest, RefusesWhatIsNotOfTheType) {
  for (const char* text : {"", "x", "0.7x", " 0.7", "0,7", "nan", "true"})
    EXPECT_NE(error_of("gate.probability", text), "");
  for (const char* text : {"", "7.5", "1e3", "99999999999999999999", "0x10"})
    EXPECT_NE(error_of("filter.particles", text), "");
  for (const char* text : {"", "yes", "1", "True"}) EXPECT_NE(error_of("gate.verbose", text), "");
  EXPECT_EQ(error_of("run.colour", "pink"), "here: run.colour cannot be 'pink'; allowed: red, green or blue");
  EXPECT_EQ(options_, Options{});
}

TEST_F(ConfigTest, NamesTheFlagThatSetAKey) {
  EXPECT_TRUE(schema_.set_by_flag("--particles", "filter.particles", "7").ok());
  EXPECT_EQ(options_.particles, 7);
  EXPECT_EQ(schema_.set_by_flag("--colour", "run.colour", "pink").error().message,
            "--colour cannot be 'pink'; allowed: red, green or blue");
}

TEST_F(ConfigTest, SuggestsTheNearestKey) {
  EXPECT_EQ(error_of("gate.probabilty", "1"),
            "here: unknown key gate.probabilty; did you mean gate.probability?");
  EXPECT_THAT(error_of("filter.particle", "1"), HasSubstr("did you mean filter.particles?"));
  EXPECT_THAT(error_of("qqqqqqqqqqqqqqqqqqqq", "1"), HasSubstr("`waymark config --all` lists all keys"));
}

TEST_F(ConfigTest, SuggestsTheRightSection) {
  EXPECT_THAT(error_of("particles", "1"), HasSubstr("did you mean filter.particles?"));
  EXPECT_THAT(error_of("fastslam.particles", "1"), HasSubstr("did you mean filter.particles?"));
}

TEST_F(ConfigTest, SuggestsTheNearestSectionWhereSeveralHaveTheKey) {
  double x_m = 0.0;
  schema_.real("sensor.x_m", x_m, {}, "");
  EXPECT_THAT(error_of("sensr.x_m", "1"), HasSubstr("did you mean sensor.x_m?"));
  EXPECT_THAT(error_of("camra.x_m", "1"), HasSubstr("did you mean camera.x_m?"));
}

TEST_F(ConfigTest, ListsCloseKeysTheLikeliestFirst) {
  using testing::ElementsAre;
  EXPECT_THAT(schema_.close_keys("particle", 3), ElementsAre("filter.particles"));
  EXPECT_THAT(schema_.close_keys("run.nam", 3), ElementsAre("run.name"));
  EXPECT_THAT(schema_.close_keys("xyzzy", 3), ElementsAre());
  EXPECT_EQ(schema_.close_keys("seed", 1), std::vector<std::string>{"seed"});
}

TEST_F(ConfigTest, TakesAssignmentsFromTheCommandLine) {
  EXPECT_TRUE(schema_.set_assignment("run.name=a=b", "--set").ok());
  EXPECT_EQ(options_.name, "a=b");
  EXPECT_TRUE(schema_.set_assignment("run.name=", "--set").ok());
  EXPECT_EQ(options_.name, "");
  const auto wrong = schema_.set_assignment("run.name", "--set");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().message, "--set: 'run.name' is not of the form key=value");
}

TEST_F(ConfigTest, ReadsSections) {
  EXPECT_EQ(
      load_error("seed: 5\ngate:\n  probability: 0.9\n  verbose: true\nrun: {name: 'x: y', colour: red}\n"),
      "");
  EXPECT_EQ(options_, (Options{0.9, -0.25, 100, 5, true, "x: y", Colour::kRed}));
}

TEST_F(ConfigTest, AnEmptyFileChangesNothing) {
  for (const char* yaml : {"", "\n", "# nothing\n", "---\n", "{}"}) EXPECT_EQ(load_error(yaml), "") << yaml;
  EXPECT_EQ(options_, Options{});
}

TEST_F(ConfigTest, ErrorsNameFileAndLine) {
  EXPECT_THAT(load_error("gate:\n  verbose: true\n  probability: 7\n"),
              StartsWith("robot.yaml:3: gate.probability cannot be '7'"));
  EXPECT_THAT(load_error("# comment\n\ngat:\n  verbose: true\n"),
              StartsWith("robot.yaml:4: unknown key gat.verbose"));
}

TEST_F(ConfigTest, RefusesWhatIsNotASingleValue) {
  EXPECT_EQ(load_error("gate:\n  probability: [0.9, 0.8]\n"),
            "robot.yaml:2: gate.probability cannot be a list");
  EXPECT_EQ(load_error("gate:\n  probability:\n"), "robot.yaml:2: gate.probability has no value");
  EXPECT_THAT(load_error("gate: 5\n"), StartsWith("robot.yaml:1: unknown key gate"));
  EXPECT_THAT(load_error("gate:\n  probability:\n    low: 1\n"),
              StartsWith("robot.yaml:3: unknown key gate.probability.low"));
  EXPECT_THAT(load_error("- a\n- b\n"), StartsWith("robot.yaml:1: expected lines"));
  EXPECT_THAT(load_error("just words"), StartsWith("robot.yaml:1: expected lines"));
}

TEST_F(ConfigTest, RefusesMalformedYamlWithItsLine) {
  EXPECT_THAT(load_error("gate:\n  probability: [0.9\n"), StartsWith("robot.yaml:3: "));
  EXPECT_THAT(load_error("gate:\n  probability: 0.9\n wrong: 1\n"), StartsWith("robot.yaml:3: "));
  EXPECT_THAT(load_error("run: *nobody\n"), StartsWith("robot.yaml:1: "));
}

TEST_F(ConfigTest, RefusesASectionInsideItself) {
  EXPECT_THAT(load_error("gate: &loop\n  again: *loop\n"),
              HasSubstr("robot.yaml:2: an alias refers to a node that contains it"));
}

TEST_F(ConfigTest, SurvivesRandomlyDamagedFiles) {
  const std::string whole = schema_.to_yaml();
  RandomStream random(1, StreamPurpose::kWorld);
  for (int i = 0; i < 500; ++i) {
    std::string damaged = whole;
    for (int j = 0; j < 3; ++j)
      damaged[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(whole.size())))] =
          "\n:'\"{}[]&*-#\t x\0"[static_cast<std::size_t>(random.uniform(0.0, 17.0))];
    const std::string error = load_error(damaged);
    EXPECT_TRUE(error.empty() || error.starts_with("robot.yaml:")) << error << "\n" << damaged;
  }
}

TEST_F(ConfigTest, ReadsFiles) {
  const auto path = std::filesystem::path(testing::TempDir()) / "waymark_config_test.yaml";
  std::ofstream(path) << "filter:\n  particles: 3\n";
  EXPECT_TRUE(schema_.load_file(path).ok());
  EXPECT_EQ(options_.particles, 3);
  std::ofstream(path) << "filter:\n  particles: many\n";
  EXPECT_THAT(schema_.load_file(path).error().message, StartsWith(path.string() + ":2: filter.particles"));
  std::filesystem::remove(path);
  EXPECT_EQ(schema_.load_file(path).error().message,
            "cannot read " + path.string() + ": No such file or directory");
  EXPECT_EQ(schema_.load_file(testing::TempDir()).error().message,
            "cannot read " + testing::TempDir() + ": Is a directory");
}

TEST_F(ConfigTest, PrintsHelpLimitsAndDefaults) {
  ASSERT_TRUE(schema_.set("gate.probability", "0.75", "here").ok());
  EXPECT_THAT(schema_.to_yaml(),
              HasSubstr("gate:\n"
                        "  # part of the true observations that may pass (0.5 to 1; default 0.99)\n"
                        "  probability: 0.75\n"
                        "  # tell what was refused (true or false; default false)\n"
                        "  verbose: false\n"));
}

TEST_F(ConfigTest, ATemplateSetsOnlyWhatWasSet) {
  ASSERT_TRUE(schema_.set("gate.probability", "0.75", "here").ok());
  const std::string yaml = schema_.to_template([](const std::string&) { return true; });
  EXPECT_THAT(yaml, HasSubstr("\n  probability: 0.75\n"));
  EXPECT_THAT(yaml, HasSubstr("\n  #verbose: false\n"));
  options_ = {};
  options_.particles = 12;
  EXPECT_EQ(load_error(yaml), "");
  EXPECT_EQ(options_.probability, 0.75);
  EXPECT_EQ(options_.particles, 12) << "what was not set stays what it was";
}

TEST_F(ConfigTest, PrintsEverySectionOnce) {
  const std::string yaml = schema_.to_yaml();
  EXPECT_EQ(yaml.find("\ngate:\n"), yaml.rfind("\ngate:\n")) << yaml;
}

/// What one schema prints another reads back.
void expect_round_trip(Options original) {
  Schema schema;
  describe(schema, original);
  Options copy;
  Schema reader;
  describe(reader, copy);
  const auto done = reader.load_text(schema.to_yaml(), "copy");
  ASSERT_TRUE(done.ok()) << done.error().message << "\n" << schema.to_yaml();
  EXPECT_EQ(copy, original) << schema.to_yaml();
}

TEST(ConfigRoundTrip, KeepsAwkwardTexts) {
  for (const char* text : {"",
                           " ",
                           " a",
                           "a ",
                           "~",
                           "null",
                           "Null",
                           "NULL",
                           "true",
                           "yes",
                           "5",
                           "0x10",
                           "1e5",
                           ".inf",
                           "nan",
                           "-",
                           "- a",
                           "---",
                           "...",
                           "?",
                           "? a",
                           ":",
                           "a: b",
                           "a:b",
                           "#",
                           "a #b",
                           "'",
                           "\"",
                           "it's",
                           "say \"hi\"",
                           "{a",
                           "[a",
                           "a]",
                           "a, b",
                           "&a",
                           "*a",
                           "!a",
                           "|",
                           ">",
                           "%a",
                           "@a",
                           "`a",
                           "<<",
                           "=",
                           "a\nb",
                           "\n",
                           "a\tb",
                           "\r\n",
                           "\x01",
                           "\x7f",
                           "C:\\new\\table",
                           "\\",
                           "\\x41",
                           "../shared/data",
                           "r\xc3\xa9sum\xc3\xa9 \xe2\x86\x92",
                           "sim:loop"}) {
    Options options;
    options.name = text;
    expect_round_trip(options);
  }
}

TEST(ConfigRoundTrip, KeepsEveryBitOfRandomNumbers) {
  RandomStream random(2, StreamPurpose::kWorld);
  for (int i = 0; i < 500; ++i) {
    Options options;
    options.probability = random.uniform(0.5, 1.0);
    options.offset_m = random.normal() * std::pow(10.0, random.uniform(-300.0, 300.0));
    options.particles = static_cast<int>(random.uniform(1.0, 10000.0));
    options.seed = static_cast<std::uint64_t>(random.uniform(0.0, 1.8e19));
    options.verbose = i % 2 == 0;
    options.colour = static_cast<Colour>(i % 3);
    expect_round_trip(options);
  }
}

TEST(ConfigRoundTrip, AnAwkwardDefaultDoesNotLeaveItsComment) {
  std::string name = "first\nsecond: line";
  Schema schema;
  schema.text("run.name", name, "title");
  EXPECT_TRUE(schema.load_text(schema.to_yaml(), "copy").ok()) << schema.to_yaml();
  EXPECT_EQ(name, "first\nsecond: line");
}

TEST(ConfigRoundTrip, KeysWithoutSectionMayComeAfterSections) {
  double x = 1.0;
  double y = 2.0;
  Schema schema;
  schema.real("a.x", x, {}, "");
  schema.real("y", y, {}, "");
  EXPECT_TRUE(schema.load_text(schema.to_yaml(), "copy").ok()) << schema.to_yaml();
}

}  // namespace
}  // namespace waymark
