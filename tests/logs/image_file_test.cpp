#include "workbench/logs/image_file.hpp"

#include <cstdio>
#include <cstdlib>

#include <gmock/gmock.h>
#include <jpeglib.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

GreyImage slopes(int width_px, int height_px) {
  GreyImage image(width_px, height_px);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) image(u, v) = static_cast<std::uint8_t>((3 * u + 5 * v) % 256);
  return image;
}

enum class JpegKind { kBaseline, kProgressive };

/// Rows of samples, as many to a pixel as the colours of the file have.
std::string jpeg_bytes(const GreyImage& samples, J_COLOR_SPACE colours, J_COLOR_SPACE stored, JpegKind kind) {
  const int channels = colours == JCS_CMYK ? 4 : 1;
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = static_cast<JDIMENSION>(samples.width_px() / channels);
  jpeg.image_height = static_cast<JDIMENSION>(samples.height_px());
  jpeg.input_components = channels;
  jpeg.in_color_space = colours;
  jpeg_set_defaults(&jpeg);
  jpeg_set_colorspace(&jpeg, stored);
  if (kind == JpegKind::kProgressive) jpeg_simple_progression(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  GreyImage copy = samples;
  for (int v = 0; v < samples.height_px(); ++v) {
    JSAMPROW row = &copy(0, v);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string bytes(reinterpret_cast<const char*>(memory), size);
  std::free(memory);
  return bytes;
}

std::string jpeg_bytes(const GreyImage& image) {
  return jpeg_bytes(image, JCS_GRAYSCALE, JCS_GRAYSCALE, JpegKind::kBaseline);
}

std::string error_of(const Result<GreyImage>& image) {
  return image.ok() ? "no error" : image.error().message;
}

TEST(ImageFile, PngGivesBackThePixels) {
  const TempFolder folder;
  const auto file = folder.path() / "a.png";
  const GreyImage image = slopes(37, 21);
  ASSERT_TRUE(write_png(file, image).ok());
  const auto read = read_image(file, ImageSize{37, 21});
  ASSERT_TRUE(read.ok()) << error_of(read);
  EXPECT_EQ(*read, image);
}

TEST(ImageFile, PartOfAnImageCanBeWritten) {
  const TempFolder folder;
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_png(file, slopes(37, 21).view().part(3, 4, 8, 9)).ok());
  const auto read = read_image(file);
  ASSERT_TRUE(read.ok()) << error_of(read);
  EXPECT_EQ((*read)(0, 0), 3 * 3 + 5 * 4);
  EXPECT_EQ(read->height_px(), 9);
}

TEST(ImageFile, JpegGivesBackAlmostThePixels) {
  GreyImage image(40, 24);
  for (int v = 0; v < 24; ++v)
    for (int u = 0; u < 40; ++u) image(u, v) = static_cast<std::uint8_t>(3 * u + 4 * v);
  const auto read = decode_image(jpeg_bytes(image), "a.jpg");
  ASSERT_TRUE(read.ok()) << error_of(read);
  for (int v = 0; v < 24; ++v)
    for (int u = 0; u < 40; ++u) EXPECT_NEAR((*read)(u, v), image(u, v), 4);
}

TEST(ImageFile, ReadsProgressiveJpeg) {
  const GreyImage image(40, 24, 90);
  const auto read =
      decode_image(jpeg_bytes(image, JCS_GRAYSCALE, JCS_GRAYSCALE, JpegKind::kProgressive), "a.jpg");
  ASSERT_TRUE(read.ok()) << error_of(read);
  EXPECT_NEAR((*read)(20, 12), 90, 1);
}

TEST(ImageFile, ReadsPrintingInksWhereOfNoneIs255) {
  // Cyan, magenta, yellow and black of one colour everywhere: (1 - c) (1 - k) of the light is left.
  GreyImage samples(4 * 32, 16);
  for (int v = 0; v < 16; ++v)
    for (int u = 0; u < 32; ++u) {
      samples(4 * u, v) = 200;
      samples(4 * u + 1, v) = 100;
      samples(4 * u + 2, v) = 50;
      samples(4 * u + 3, v) = 153;
    }
  const int expected = (299 * 200 + 587 * 100 + 114 * 50) * 153 / 255 / 1000;
  for (const J_COLOR_SPACE stored : {JCS_CMYK, JCS_YCCK})
    for (const JpegKind kind : {JpegKind::kBaseline, JpegKind::kProgressive}) {
      const auto read = decode_image(jpeg_bytes(samples, JCS_CMYK, stored, kind), "a.jpg", ImageSize{32, 16});
      ASSERT_TRUE(read.ok()) << error_of(read);
      for (int v = 0; v < 16; ++v)
        for (int u = 0; u < 32; ++u) EXPECT_NEAR((*read)(u, v), expected, 3);
    }
}

TEST(ImageFile, NamesTheKindsOfJpegThatItDoesNotRead) {
  std::string differential = jpeg_bytes(slopes(16, 16));
  const auto frame = differential.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  differential[frame + 1] = '\xC5';
  EXPECT_THAT(error_of(decode_image(differential, "a.jpg")),
              AllOf(HasSubstr("a.jpg: a kind of JPEG that is not supported"), Not(HasSubstr("damaged"))));
  std::string deep = jpeg_bytes(slopes(16, 16));
  deep[deep.find("\xFF\xC0") + 4] = 12;
  EXPECT_THAT(error_of(decode_image(deep, "a.jpg")), HasSubstr("precision 12"));
}

TEST(ImageFile, ColourBecomesTheWeightedMean) {
  // One row: pure red, green and blue.
  static constexpr unsigned char kPng[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
      0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x01, 0x08, 0x02, 0x00, 0x00, 0x00, 0x94, 0x82, 0x83,
      0xe3, 0x00, 0x00, 0x00, 0x15, 0x49, 0x44, 0x41, 0x54, 0x78, 0x01, 0x01, 0x0a, 0x00, 0xf5, 0xff,
      0x00, 0xff, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00, 0x00, 0xff, 0x0e, 0xfb, 0x02, 0xfe, 0xf2, 0x0f,
      0x8d, 0xee, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const auto image = decode_image({reinterpret_cast<const char*>(kPng), sizeof kPng}, "rgb", ImageSize{3, 1});
  ASSERT_TRUE(image.ok()) << error_of(image);
  EXPECT_EQ((*image)(0, 0), 76);   // 0.299 * 255
  EXPECT_EQ((*image)(1, 0), 150);  // 0.587 * 255
  EXPECT_EQ((*image)(2, 0), 29);   // 0.114 * 255
}

TEST(ImageFile, PgmGivesBackThePixels) {
  const std::string pixels("\0\n#\xff 1", 6);
  const auto image = decode_image("P5 # grey\n3\n2\t255\n" + pixels, "a.pgm", ImageSize{3, 2});
  ASSERT_TRUE(image.ok()) << error_of(image);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(image->data()[i], static_cast<std::uint8_t>(pixels[std::size_t(i)]));
}

TEST(ImageFile, APgmIsScaledByItsWhite) {
  const auto grey = decode_image(std::string("P5 3 1 100\n\0\x32\x64", 14), "a.pgm");
  ASSERT_TRUE(grey.ok()) << error_of(grey);
  EXPECT_EQ((*grey)(0, 0), 0);
  EXPECT_EQ((*grey)(1, 0), 128);
  EXPECT_EQ((*grey)(2, 0), 255);
  // Two bytes each, the upper one first: 256 and 4095 of 4095, and of 65535, which says nothing.
  for (const char* white : {"4095", "65535"}) {
    const std::string head = std::string("P5 2 1 ") + white + "\n";
    const auto deep = decode_image(head + std::string("\1\0\x0f\xff", 4), "a.pgm");
    ASSERT_TRUE(deep.ok()) << error_of(deep);
    EXPECT_EQ((*deep)(0, 0), 16) << white;
    EXPECT_EQ((*deep)(1, 0), 255) << white;
  }
}

TEST(ImageFile, DamagedPgmIsAnError) {
  EXPECT_THAT(error_of(decode_image("P5", "a")),
              HasSubstr("a: damaged PGM file: width, height and maximum grey value are missing"));
  EXPECT_THAT(error_of(decode_image("P5 3 2 # 255", "a")),
              HasSubstr("width, height and maximum grey value are missing"));
  EXPECT_THAT(error_of(decode_image("P5 3 2 65536\n", "a")), HasSubstr("the maximum grey value is 65536"));
  EXPECT_THAT(error_of(decode_image("P5 3 2 0\n", "a")), HasSubstr("the maximum grey value is 0"));
  EXPECT_THAT(error_of(decode_image("P5 3 2 65535\n12345678901", "a")), HasSubstr("is cut off"));
  EXPECT_THAT(error_of(decode_image("P5 3 2 255\n12345", "a")), HasSubstr("is cut off"));
  EXPECT_THAT(error_of(decode_image("P5 -3 2 255\n", "a")), HasSubstr("each side must have"));
  EXPECT_THAT(error_of(decode_image("P5 3 2 255\n123456", "a", ImageSize{2, 3})),
              HasSubstr("expected 2 x 3"));
}

TEST(ImageFile, WhatIsNoImageIsAnErrorThatSaysSo) {
  const TempFolder folder;
  EXPECT_THAT(error_of(read_image(folder.write("a.png", "hello"))),
              AllOf(HasSubstr("a.png"), HasSubstr("expected a PNG, JPEG or PGM")));
  EXPECT_THAT(error_of(read_image(folder.write("b.png", ""))), HasSubstr("is empty"));
  EXPECT_THAT(error_of(read_image(folder.path() / "none.png")), HasSubstr("No such file"));
  EXPECT_THAT(error_of(decode_image(std::string_view("II*\0rest", 8), "c")), HasSubstr("c: is a TIFF image"));
}

TEST(ImageFile, AnotherSizeThanExpectedIsAnError) {
  const TempFolder folder;
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_png(file, slopes(30, 20)).ok());
  EXPECT_THAT(error_of(read_image(file, ImageSize{320, 240})),
              HasSubstr("has 30 x 20 pixels, expected 320 x 240"));
  EXPECT_THAT(error_of(decode_image(jpeg_bytes(slopes(8, 9)), "b.jpg", ImageSize{9, 8})),
              HasSubstr("has 8 x 9 pixels, expected 9 x 8"));
}

TEST(ImageFile, CutOffAnywhereIsAnErrorOfOneLine) {
  const TempFolder folder;
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_png(file, slopes(64, 48)).ok());
  for (const std::string& bytes : {*read_file(file), jpeg_bytes(slopes(64, 48))}) {
    for (std::size_t size = 0; size + 2 < bytes.size(); size += 1 + size / 16) {
      const auto image = decode_image(std::string_view(bytes).substr(0, size), "cut");
      ASSERT_FALSE(image.ok()) << size << " of " << bytes.size();
      EXPECT_THAT(image.error().message, HasSubstr("cut: "));
      EXPECT_EQ(image.error().message.find('\n'), std::string::npos);
    }
  }
}

TEST(ImageFile, DamagedBytesAreNeverACrash) {
  const TempFolder folder;
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_png(file, slopes(64, 48)).ok());
  for (const std::string& bytes : {*read_file(file), jpeg_bytes(slopes(64, 48))}) {
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
      const auto image = decode_image(damaged, "damaged");
      EXPECT_TRUE(image.ok() || !image.error().message.empty());
    }
  }
}

TEST(ImageFile, ReadsPhotographs) {
  WAYMARK_REQUIRE_DATA("gray-images");
  const auto graf = read_image(test::data_path("gray-images/graf1.png"), ImageSize{800, 640});
  ASSERT_TRUE(graf.ok()) << error_of(graf);
  const auto leuven = read_image(test::data_path("gray-images/leuvenA.jpg"), ImageSize{751, 563});
  ASSERT_TRUE(leuven.ok()) << error_of(leuven);
}

}  // namespace
}  // namespace waymark
