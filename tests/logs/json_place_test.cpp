#include "workbench/logs/json_place.hpp"

#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace waymark {
namespace {

using Json = nlohmann::json;
using Place = JsonPlace<Json>;

/// What reading says that it cannot.
template <class Read>
std::string error_of(const Read& read) {
  try {
    read();
  } catch (const JsonError& error) {
    return error.what();
  }
  return "none";
}

TEST(JsonPlace, ReadsValuesOfTheirType) {
  const Json json = Json::parse(R"({"a": [{"b": 2.5}, {"b": 3.0}], "c": "text", "d": 255})");
  const Place place(json);
  EXPECT_EQ(place.at("a").items()[0].at("b").number(), 2.5);
  EXPECT_EQ(place.at("a").items(2)[1].at("b").whole<int>(), 3);
  EXPECT_EQ(place.at("c").text(), "text");
  EXPECT_EQ(place.at("d").whole<std::uint8_t>(), 255);
}

TEST(JsonPlace, SaysWhereAndWhyNot) {
  const Json json = Json::parse(R"({"a": [{"b": 2.5}, {"b": 256}, {"b": -1}, {"b": 1e300}], "c": null})");
  const Place place(json);
  const auto items = place.at("a").items();
  EXPECT_EQ(error_of([&] { (void)items[0].at("b").whole<int>(); }),
            "a[0].b: 2.5 is not a whole number from -2147483648 to 2147483647");
  EXPECT_EQ(error_of([&] { (void)items[1].at("b").whole<std::uint8_t>(); }),
            "a[1].b: 256 is not a whole number from 0 to 255");
  EXPECT_THAT(error_of([&] { (void)items[2].at("b").whole<std::uint8_t>(); }),
              testing::HasSubstr("a[2].b: -1"));
  EXPECT_THAT(error_of([&] { (void)items[3].at("b").whole<int>(); }), testing::HasSubstr("a[3].b: 1e+300"));
  EXPECT_EQ(error_of([&] { (void)place.at("c").number(); }), "c: is not a number");
  EXPECT_EQ(error_of([&] { (void)place.at("c").text(); }), "c: is not a text");
  EXPECT_EQ(error_of([&] { (void)place.at("c").items(); }), "c: is not a list");
  EXPECT_EQ(error_of([&] { (void)place.at("a").items(3); }), "a: has 4 items; expected 3");
  EXPECT_EQ(error_of([&] { (void)place.at("z"); }), "z is missing");
  EXPECT_EQ(error_of([&] { (void)items[0].at("z"); }), "a[0]: z is missing");
}

}  // namespace
}  // namespace waymark
