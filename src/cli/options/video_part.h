#pragma once
#include <optional>
#include <string>

#include "study/data/video_part.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// The part of a video that a verb uses, as given on the command line.
struct PartOptions {
  std::optional<double> from, to;
  /// Throws Error(usage) when the part is empty. `fps`: see VideoPart.
  VideoPart part(double fps = 0) const;
};

/// Adds --from and --to.
void add_part_options(CLI::App* v, PartOptions& o);
/// Adds --threads; 0: all.
void add_threads_option(CLI::App* v, unsigned& threads);

/// For options in seconds: converts "1.2 s" and "300 ms" to a number; returns any other text unchanged.
std::string in_seconds(std::string text);

}  // namespace faba::cli
