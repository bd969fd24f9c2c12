#include "workbench/bags/message_decoder.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "bags/wire.hpp"

namespace waymark::bag {
namespace {

using test::Wire;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kDefinition =
    "# a comment\n"
    "int32 LIMIT=5\n"
    "string NAME = none # of a constant\n"
    "uint8 flag\n"
    "float64 x 1.5\n"
    "string label\n"
    "Part[] parts\n"
    "float32[2] pair\n"
    "uint8[] data\n"
    "time when\n"
    "================================================================================\n"
    "MSG: demo/Part\n"
    "int32[] ids\n"
    "float64 size\n"
    "string name\n";

Topic topic(Encoding encoding, std::string definition = kDefinition) {
  return {.name = "/demo", .type = "demo/Whole", .encoding = encoding, .definition = std::move(definition)};
}

const WantedFields kWanted{{"x", "parts.ids", "parts.size", "PAIR", "when.sec", "when.nanosec"},
                           {"label", "data", "parts.name"}};

/// One message of that definition.
std::string written(Wire wire) {
  wire.add<std::uint8_t>(7).add(2.5).text("hello");
  wire.add<std::uint32_t>(3);
  wire.add<std::uint32_t>(2).add<std::int32_t>(41).add<std::int32_t>(42).add(0.25).text("a");
  wire.add<std::uint32_t>(0).add(0.5).text("");
  wire.add<std::uint32_t>(1).add<std::int32_t>(-9).add(0.75).text("ccc");
  wire.add(1.5F)
      .add(-2.0F)
      .text("\x01\x02\x03", Wire::Text::kBytes)
      .add<std::uint32_t>(1700000000)
      .add<std::uint32_t>(5);
  return wire.bytes();
}

void expect_all_fields(MessageDecoder& decoder, const std::string& bytes) {
  const auto done = decoder.decode(bytes);
  ASSERT_TRUE(done.ok()) << done.error().message;
  EXPECT_THAT(decoder.numbers(0), ElementsAre(2.5));
  ASSERT_EQ(decoder.numbers(1).size(), 3U);
  EXPECT_EQ(decoder.numbers(1)[0], 41.0);
  EXPECT_TRUE(std::isnan(decoder.numbers(1)[1]));
  EXPECT_EQ(decoder.numbers(1)[2], -9.0);
  EXPECT_THAT(decoder.numbers(2), ElementsAre(0.25, 0.5, 0.75));
  EXPECT_THAT(decoder.numbers(3), ElementsAre(1.5, -2.0));
  EXPECT_EQ(decoder.number(4), 1700000000.0);
  EXPECT_EQ(decoder.size(5), 5U);
  EXPECT_EQ(decoder.text(0), "hello");
  EXPECT_EQ(decoder.text(1), "\x01\x02\x03");
  EXPECT_THAT(decoder.texts(2), ElementsAre("a", "", "ccc"));
}

TEST(MessageDecoder, ReadsRos1AndCdrOfBothByteOrders) {
  for (const auto& [encoding, order] : {std::pair{Encoding::kRos1, std::endian::little},
                                        {Encoding::kCdr, std::endian::little},
                                        {Encoding::kCdr, std::endian::big}}) {
    auto decoder = MessageDecoder::make(topic(encoding), kWanted);
    ASSERT_TRUE(decoder.ok()) << decoder.error().message;
    const std::string bytes = written(Wire(encoding, order));
    expect_all_fields(*decoder, bytes);
    expect_all_fields(*decoder, bytes);  // nothing is left of the message before
  }
}

TEST(MessageDecoder, RefusesEveryMessageThatIsTooShortOrTooLong) {
  for (const Encoding encoding : {Encoding::kRos1, Encoding::kCdr}) {
    auto decoder = MessageDecoder::make(topic(encoding), kWanted);
    ASSERT_TRUE(decoder.ok());
    const std::string whole = written(Wire(encoding));
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_FALSE(decoder->decode(std::string_view(whole).substr(0, size)).ok()) << size;
    EXPECT_THAT(decoder->decode(whole + std::string(8, '\0')).error().message,
                HasSubstr("by its definition"));
  }
}

TEST(MessageDecoder, SaysWhichFieldIsMissing) {
  const auto missing = MessageDecoder::make(topic(Encoding::kCdr), {{"parts.weight"}, {}});
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().message,
              HasSubstr("/demo: the definition of demo/Whole in the bag has no number "
                        "parts.weight"));
  EXPECT_FALSE(MessageDecoder::make(topic(Encoding::kCdr), {{"label"}, {}}).ok()) << "a text is no number";
  EXPECT_FALSE(MessageDecoder::make(topic(Encoding::kCdr), {{"parts"}, {}}).ok()) << "nor is a message";
}

TEST(MessageDecoder, RefusesDefinitionsThatCannotBe) {
  const auto error = [](const char* definition) {
    const auto fields = parse_definition(topic(Encoding::kRos1, definition));
    return fields ? std::string() : fields.error().message;
  };
  EXPECT_THAT(error("Other other\n"), HasSubstr("does not include that of demo/Other"));
  EXPECT_THAT(error("Loop loop\n====\n========\nMSG: demo/Loop\nLoop loop\n"), HasSubstr("contains itself"));
  EXPECT_THAT(error("int32[x] numbers\n"), HasSubstr("cannot be read"));
  EXPECT_THAT(error("int32\n"), HasSubstr("cannot be read"));
  std::string wide = "A a\n";
  for (char c = 'A'; c < 'K'; ++c) {
    wide += std::string(80, '=') + "\nMSG: demo/" + c + "\n";
    for (int i = 0; i < 10; ++i)
      wide += std::string(1, static_cast<char>(c + 1)) + " f" + std::to_string(i) + "\n";
  }
  wide += std::string(80, '=') + "\nMSG: demo/K\nuint8 last\n";
  EXPECT_THAT(error(wide.c_str()), HasSubstr("cannot be read")) << "10^10 fields";
}

TEST(MessageDecoder, EndsSoonWhateverCountsAMessageNames) {
  // Messages without content take no bytes in ROS 1: a count of them could run for ever.
  const Topic hollow =
      topic(Encoding::kRos1, "Empty[4000000000] all\n========\nMSG: demo/Empty\n# nothing\n");
  auto decoder = MessageDecoder::make(hollow, {});
  ASSERT_TRUE(decoder.ok()) << decoder.error().message;
  EXPECT_FALSE(decoder->decode("").ok());
}

/// In CDR, which holds the forward speed 2.5.
std::string twist_stamped() {
  Wire wire(Encoding::kCdr);
  wire.add<std::int32_t>(10).add<std::uint32_t>(0).text("base_link");
  for (const double value : {2.5, 0.0, 0.0, 0.0, 0.0, 0.5}) wire.add(value);
  return wire.bytes();
}

const WantedFields kSpeeds{{"twist.linear.x", "twist.angular.z"}, {}};

Topic twists(std::string definition) {
  return {.name = "/speed",
          .type = "geometry_msgs/TwistStamped",
          .encoding = Encoding::kCdr,
          .definition = std::move(definition)};
}

TEST(MessageDecoder, TakesTheKnownDefinitionWhereThatInTheBagDoesNotServe) {
  for (const char* stored :
       {"module geometry_msgs { module msg { struct TwistStamped {}; }; };", "std_msgs/Header header\n",
        "  \n", "std_msgs/Header header\nTwist twist\n========\nMSG: geometry_msgs/Twist\nVector3 linear\n",
        "std_msgs/Header header\nfloat64 more\nTwist twist\n"}) {
    auto decoder = MessageDecoder::make(twists(stored), kSpeeds);
    ASSERT_TRUE(decoder.ok()) << decoder.error().message;
    ASSERT_TRUE(decoder->decode(twist_stamped()).ok()) << stored;
    EXPECT_EQ(decoder->number(0), 2.5) << stored;
    EXPECT_EQ(decoder->number(1), 0.5) << stored;
    EXPECT_THAT(decoder->note(),
                HasSubstr("/speed: read by the released definition of geometry_msgs/TwistStamped"));
  }
  auto without = MessageDecoder::make(twists(""), kSpeeds);
  ASSERT_TRUE(without.ok());
  EXPECT_TRUE(without->decode(twist_stamped()).ok());
  EXPECT_THAT(without->note(), IsEmpty());
}

TEST(MessageDecoder, StaysWithTheDefinitionInTheBagOverDamagedMessages) {
  auto decoder = MessageDecoder::make(twists("std_msgs/Header header\nTwist twist\nfloat64 more\n"), kSpeeds);
  ASSERT_TRUE(decoder.ok());
  const std::string whole = twist_stamped() + std::string(8, '\0');
  ASSERT_TRUE(decoder->decode(whole).ok());
  EXPECT_FALSE(decoder->decode(std::string_view(whole).substr(0, 50)).ok());
  EXPECT_TRUE(decoder->decode(whole).ok());
  EXPECT_EQ(decoder->number(0), 2.5);
  EXPECT_THAT(decoder->note(), IsEmpty());
}

TEST(MessageDecoder, ReadsAFieldByTheFirstNameThatTheDefinitionHas) {
  const std::vector<WantedFields> choices{{{"", "twist.angle.z"}, {}},
                                          {{"twist.linear.x", "twist.angular.z"}, {}}};
  auto decoder = MessageDecoder::make_any(twists(""), choices);
  ASSERT_TRUE(decoder.ok()) << decoder.error().message;
  ASSERT_TRUE(decoder->decode(twist_stamped()).ok());
  EXPECT_THAT(decoder->numbers(0), ElementsAre(2.5));
  const std::vector<WantedFields> half{{{"", "twist.angular.z"}, {}}};
  auto other = MessageDecoder::make_any(twists(""), half);
  ASSERT_TRUE(other.ok());
  ASSERT_TRUE(other->decode(twist_stamped()).ok());
  EXPECT_THAT(other->numbers(0), IsEmpty());
  EXPECT_THAT(other->numbers(1), ElementsAre(0.5));
}

}  // namespace
}  // namespace waymark::bag
