#include "workbench/run/film_strip.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

Stamp at_picture(int picture) { return stamp_from_seconds(picture / 30.0); }

FilmStrip film_of(int pictures, std::size_t most) {
  FilmStrip film(most);
  const std::vector<vision::Look> looks(2);
  const std::vector<Innovation> innovations{
      {.landmark = {LandmarkId::Family::kCorner, 1}},
      {.landmark = {LandmarkId::Family::kCorner, 2}, .outcome = Outcome::kGated}};
  for (int i = 0; i < pictures; ++i)
    film.add(at_picture(i), GreyImage(4, 3, static_cast<std::uint8_t>(i)), looks, innovations);
  return film;
}

TEST(FilmStrip, KeepsAllOfAShortRun) {
  const FilmStrip film = film_of(5, 8);
  ASSERT_EQ(film.frames().size(), 5U);
  EXPECT_EQ(film.frames()[3].stamp, at_picture(3));
  EXPECT_EQ(film.frames()[3].picture, GreyImage(4, 3, 3));
  EXPECT_EQ(film.frames()[3].looks.size(), 2U);
  ASSERT_EQ(film.frames()[3].refused.size(), 1U);
  EXPECT_EQ(film.frames()[3].refused[0].number, 2);
}

TEST(FilmStrip, SpreadsWhatItKeepsEvenlyOverALongRun) {
  for (const std::size_t most : {7U, 8U}) {
    for (const int pictures : {8, 9, 15, 16, 17, 100, 1441}) {
      const auto film = film_of(pictures, most);
      const auto& frames = film.frames();
      ASSERT_LE(frames.size(), most);
      EXPECT_GE(2 * frames.size(), most);
      const Duration step = frames[1].stamp - frames[0].stamp;
      EXPECT_EQ(frames.front().stamp, at_picture(0));
      for (std::size_t i = 1; i < frames.size(); ++i)
        EXPECT_NEAR(to_seconds(frames[i].stamp - frames[i - 1].stamp), to_seconds(step), 1e-6);
      EXPECT_LE(at_picture(pictures - 1) - frames.back().stamp, step);
    }
  }
}

}  // namespace
}  // namespace waymark
