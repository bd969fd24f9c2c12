#include "workbench/study/axis.hpp"

#include <gmock/gmock.h>

namespace waymark::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string error_of(std::string_view text) { return parse_axis(text).error().message; }

TEST(Axis, ReadsValuesAndSpansOfWholeNumbers) {
  const auto particles = parse_axis("fastslam.particles=10,30, 100").value();
  EXPECT_EQ(particles.key, "fastslam.particles");
  EXPECT_THAT(particles.values, ElementsAre("10", "30", "100"));
  EXPECT_THAT(parse_axis("seed=7,1..3").value().values, ElementsAre("7", "1", "2", "3"));
  EXPECT_THAT(parse_axis("observe=range-bearing,range").value().values,
              ElementsAre("range-bearing", "range"));
  EXPECT_THAT(parse_axis("sensor.range_sigma_m=0.1,1e-2").value().values, ElementsAre("0.1", "1e-2"));
  EXPECT_THAT(parse_axis("seed=4..4").value().values, ElementsAre("4"));
}

TEST(Axis, UnknownKeyNamesThoseThatAreClose) {
  EXPECT_EQ(error_of("particles=1"),
            "--axis: unknown key particles; close keys: fastslam.particles, pixel.article");
  EXPECT_THAT(error_of("sensor.range_sigm=1"), HasSubstr("close keys: sensor.range_sigma_m"));
  EXPECT_EQ(error_of("xyzzy=1"), "--axis: unknown key xyzzy; `waymark config --all` lists all keys");
}

TEST(Axis, ValuesAreThoseThatTheConfigTakes) {
  EXPECT_THAT(error_of("fastslam.particles=10,0"),
              StartsWith("--axis: fastslam.particles cannot be '0'; allowed:"));
  EXPECT_THAT(error_of("observe=sonar"), HasSubstr("allowed: range-bearing"));
  EXPECT_THAT(error_of("seed=1,,2"), HasSubstr("seed cannot be ''"));
}

TEST(Axis, MistakesOfFormAreNamed) {
  for (const char* text : {"seed", "=1", "seed="})
    EXPECT_THAT(error_of(text), HasSubstr("not of the form")) << text;
  EXPECT_THAT(error_of("seed=5..1"), HasSubstr("5..1 decreases"));
  EXPECT_THAT(error_of("seed=1..2000000000"), HasSubstr("more than 100000 values"));
  EXPECT_THAT(error_of("seed=1,2,1"), HasSubstr("seed has the value 1 twice"));
}

}  // namespace
}  // namespace waymark::study
