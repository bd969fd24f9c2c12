#pragma once

namespace waymark::vision {

struct FinderOptions {
  int patch_px = 16;
  bool warp = true;      ///< to the viewpoint; otherwise patches stay as they were cut
  bool subpixel = true;  ///< otherwise places are known to the whole pixel
};

}  // namespace waymark::vision
