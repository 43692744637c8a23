#pragma once
#include <string>

#include "tests/e2e/program.h"

namespace faba {

/// Writes a scene whose camera plays back `frames` noisy pictures, 64 x 48 px, at 200 Hz: bench.toml in
/// `folder`. Noise cannot be compressed, so that each picture needs 3 KB in any format.
inline void write_playback_scene(const std::filesystem::path& folder, int frames) {
  std::filesystem::create_directory(folder / "film");
  unsigned state = 1;
  for (int k = 0; k < frames; ++k) {
    std::string picture = "P5\n64 48\n255\n";
    for (int i = 0; i < 64 * 48; ++i) {
      state = 1664525u * state + 1013904223u;  // Numerical Recipes
      picture += char(state >> 24);
    }
    write_file(folder / ("film/f" + std::to_string(1000 + k) + ".pgm"), picture);
  }
  write_file(folder / "bench.toml",
             "[[swarm]]\ncount = 5\nmodel = 'basic'\n[arena]\ntype = 'box'\nsize_px = [64, 48]\n"
             "[rig]\ncamera = { type = 'playback', file = 'film', fps = 200 }\ndriver = { type = 'none' }\n");
}

}  // namespace faba
