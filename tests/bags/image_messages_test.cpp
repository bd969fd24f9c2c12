#include "workbench/bags/image_messages.hpp"

#include <bit>

#include <gmock/gmock.h>

#include "bags/wire.hpp"

namespace waymark::bag {
namespace {

using test::Wire;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What a camera publishes.
struct Made {
  std::string encoding;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::string data;
  std::uint32_t step = 0;
  std::endian order = std::endian::little;
};

TopicReader raw_reader() {
  auto reader = image_reader(
      {.name = "/raw", .type = "sensor_msgs/Image", .encoding = Encoding::kCdr, .definition = {}});
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  return *std::move(reader);
}

Result<EventContent> read(TopicReader& reader, const Made& made) {
  Wire wire(Encoding::kCdr);
  wire.add<std::int32_t>(1).add<std::uint32_t>(0).text("camera").add(made.height_px).add(made.width_px);
  wire.text(made.encoding).add<std::uint8_t>(made.order == std::endian::big ? 1 : 0).add(made.step);
  const std::string bytes = wire.text(made.data, Wire::Text::kBytes).bytes();
  const auto done = reader.decoder.decode(bytes);
  EXPECT_TRUE(done.ok()) << done.error().message;
  return reader.content(reader.decoder);
}

/// Its grey values, row after row.
std::vector<int> greys(const Result<EventContent>& content) {
  EXPECT_TRUE(content.ok()) << content.error().message;
  if (!content) return {};
  const GreyImage& image = *std::get<Image>(*content).pixels;
  return {image.data(), image.data() + image.width_px() * image.height_px()};
}

std::vector<int> greys(const Made& made) {
  TopicReader reader = raw_reader();
  return greys(read(reader, made));
}

std::string error_of(const Made& made) {
  TopicReader reader = raw_reader();
  const auto content = read(reader, made);
  return content.ok() ? "" : content.error().message;
}

std::string words(std::initializer_list<int> values, std::endian order = std::endian::little) {
  std::string bytes;
  for (const int value : values) {
    const char low = static_cast<char>(value & 255), high = static_cast<char>(value >> 8);
    bytes += order == std::endian::big ? high : low;
    bytes += order == std::endian::big ? low : high;
  }
  return bytes;
}

TEST(ImageMessages, OfYuvAreTheirLuminance) {
  for (const char* encoding : {"yuyv", "yuv422_yuy2", "YUYV"})
    EXPECT_THAT(greys({encoding, 2, 1, "\x0a\x80\x14\x80", 4}), ElementsAre(10, 20)) << encoding;
  for (const char* encoding : {"uyvy", "yuv422"})
    EXPECT_THAT(greys({encoding, 2, 1, "\x80\x0a\x80\x14", 4}), ElementsAre(10, 20)) << encoding;
}

TEST(ImageMessages, OfPlanesAreTheFirstOne) {
  const std::string luminance = "\x01\x02\x03\x04\x05\x06\x07\x08";
  for (const auto& [encoding, chroma] :
       {std::pair{"nv12", 4}, {"nv21", 4}, {"i420", 4}, {"nv16", 8}, {"nv24", 16}}) {
    const std::string data = luminance + std::string(static_cast<std::size_t>(chroma), '\x80');
    EXPECT_THAT(greys({encoding, 4, 2, data, 4}), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8)) << encoding;
    // Some divide all bytes by the rows of the first plane.
    EXPECT_THAT(greys({encoding, 4, 2, data, static_cast<std::uint32_t>(data.size() / 2)}),
                ElementsAre(1, 2, 3, 4, 5, 6, 7, 8))
        << encoding;
  }
  const std::string gaps = "\x01\x02__\x03\x04__" + std::string(4, '\x80');
  EXPECT_THAT(greys({"nv12", 2, 2, gaps, 4}), ElementsAre(1, 2, 3, 4));
}

TEST(ImageMessages, OfSixteenBitsLoseTheLowerOnes) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    EXPECT_THAT(greys({"mono16", 2, 1, words({0x1234, 0xffff}, order), 4, order}), ElementsAre(0x12, 0xff));
    const int mixed = (299 * 0xff + 587 * 0x20 + 114 * 0x10 + 500) / 1000;
    for (const char* encoding : {"rgb16", "RGB16"})
      EXPECT_THAT(greys({encoding, 1, 1, words({0xff00, 0x2000, 0x1000}, order), 6, order}),
                  ElementsAre(mixed));
    for (const char* encoding : {"bgr16", "16UC3"})
      EXPECT_THAT(greys({encoding, 1, 1, words({0x1000, 0x2000, 0xff00}, order), 6, order}),
                  ElementsAre(mixed));
    for (const char* encoding : {"bgra16", "16UC4"})
      EXPECT_THAT(greys({encoding, 1, 1, words({0x1000, 0x2000, 0xff00, 0xffff}, order), 8, order}),
                  ElementsAre(mixed));
    EXPECT_THAT(greys({"rgba16", 1, 1, words({0xff00, 0x2000, 0x1000, 0xffff}, order), 8, order}),
                ElementsAre(mixed));
    // One red, two green, one blue about every pixel.
    EXPECT_THAT(greys({"bayer_rggb16", 2, 2, words({0x8000, 0x4000, 0x4000, 0xc000}, order), 4, order}),
                ElementsAre(0x70, 0x70, 0x70, 0x70));
  }
}

TEST(ImageMessages, AreScaledByTheBitsThatTheCameraUses) {
  EXPECT_THAT(greys({"mono16", 3, 1, words({0, 512, 1023}), 6}), ElementsAre(0, 128, 255)) << "10 bits";
  EXPECT_THAT(greys({"mono16", 2, 1, words({2048, 4095}), 4}), ElementsAre(128, 255)) << "12 bits";
  EXPECT_THAT(greys({"mono16", 2, 1, words({7, 200}), 4}), ElementsAre(7, 200)) << "8 bits";
  EXPECT_THAT(greys({"rgba16", 1, 1, words({1023, 1023, 1023, 65535}), 8}), ElementsAre(255))
      << "opacity does not count";
  EXPECT_THAT(greys({"bayer_grbg16", 2, 2, words({1023, 1023, 1023, 1023}), 4}),
              ElementsAre(255, 255, 255, 255));
}

TEST(ImageMessages, DoNotFlickerWithTheLight) {
  TopicReader reader = raw_reader();
  EXPECT_THAT(reader.notes(), IsEmpty());
  const auto grey = [&reader](int value) { return greys(read(reader, {"mono16", 1, 1, words({value}), 2})); };
  EXPECT_THAT(grey(1000), ElementsAre(250));
  EXPECT_THAT(grey(4000), ElementsAre(250));
  EXPECT_THAT(grey(1000), ElementsAre(62)) << "as before the bright one, but by its bits";
  EXPECT_THAT(reader.notes(),
              ElementsAre(HasSubstr("/raw: the camera uses 12 of 16 bits (largest value 4000)")));
}

TEST(ImageMessages, MayHaveGapsBehindTheirRows) {
  EXPECT_THAT(greys({"mono16", 1, 2, words({0x1200, 0xffff, 0xff00, 0xffff}), 4}), ElementsAre(0x12, 0xff));
  EXPECT_THAT(greys({"mono16", 1, 2, words({512, 60000, 1023, 60000}), 4}), ElementsAre(128, 255))
      << "what stands in a gap does not count";
  EXPECT_THAT(greys({"yuyv", 2, 2, "\x0a_\x14_....\x1e_\x28_....", 8}), ElementsAre(10, 20, 30, 40));
}

TEST(ImageMessages, OfUnknownEncodingsAreRefusedByName) {
  for (const char* encoding : {"16UC1", "32FC1", "yuv444", "jpeg", ""})
    EXPECT_THAT(error_of({encoding, 2, 2, std::string(64, '\1'), 16}),
                HasSubstr("its image encoding '" + std::string(encoding) + "' is not supported"));
  EXPECT_THAT(error_of({"rgb16", 2, 2, std::string(12, '\1'), 6}),
              HasSubstr("too few for 2 x 2 pixels in rgb16"));
}

std::string error_of_packed(std::string_view format, std::string_view data) {
  auto reader = image_reader({.name = "/packed",
                              .type = "sensor_msgs/CompressedImage",
                              .encoding = Encoding::kCdr,
                              .definition = {}});
  EXPECT_TRUE(reader.ok()) << reader.error().message;
  Wire wire(Encoding::kCdr);
  wire.add<std::int32_t>(1).add<std::uint32_t>(0).text("camera").text(format).text(data, Wire::Text::kBytes);
  EXPECT_TRUE(reader->decoder.decode(wire.bytes()).ok());
  const auto content = reader->content(reader->decoder);
  return content.ok() ? "" : content.error().message;
}

TEST(ImageMessages, ThatArePackedAreOfAFormatThatIsRead) {
  EXPECT_EQ(error_of_packed("jpeg", "\xFF\xD8..."), "");
  EXPECT_EQ(error_of_packed("mono16; png compressed ", "\x89PNG..."), "");
  EXPECT_THAT(error_of_packed("h264", std::string_view("\0\0\0\1gop", 7)),
              HasSubstr("'h264' is not supported"));
  EXPECT_THAT(error_of_packed("16UC1; compressedDepth png", "...."), HasSubstr("depth image"));
  EXPECT_THAT(error_of_packed("16UC1; png compressed ", "\x89PNG..."), HasSubstr("depth image"));
  EXPECT_THAT(error_of_packed("jpeg", ""), HasSubstr("empty"));
}

}  // namespace
}  // namespace waymark::bag
