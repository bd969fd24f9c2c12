#include "workbench/run/image_strip.hpp"

#include <utility>

namespace waymark {

void ImageStrip::add(Stamp stamp, const GreyImage& image,
                     std::span<const vision::SearchRecord> search_records,
                     std::span<const Innovation> innovations) {
  if (seen_++ % every_ != 0) return;
  if (frames_.size() == most_) {
    for (std::size_t i = 1; 2 * i < most_; ++i) frames_[i] = std::move(frames_[2 * i]);
    frames_.resize((most_ + 1) / 2);
    every_ *= 2;
    if ((seen_ - 1) % every_ != 0) return;
  }
  StripFrame& frame = frames_.emplace_back(StripFrame{stamp, image, {}, {}});
  frame.search_records.assign(search_records.begin(), search_records.end());
  for (const Innovation& innovation : innovations)
    if (innovation.outcome == Outcome::kGated) frame.refused.push_back(innovation.landmark);
}

}  // namespace waymark
