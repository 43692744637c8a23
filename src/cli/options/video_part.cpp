#include "cli/options/video_part.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "core/error.h"
#include "core/units.h"

namespace faba::cli {

VideoPart PartOptions::part(double fps) const {
  VideoPart part{from.value_or(0), to, fps};
  if (part.ends_before(part.from_s) || (to && *to <= part.from_s))
    throw Error(Errc::usage, "--from, --to",
                fmt::format("the time from {:g} s to {:g} s is empty; --to must be later than --from",
                            part.from_s, *to));
  return part;
}

void add_part_options(CLI::App* v, PartOptions& o) {
  v->add_option("--from", o.from,
                "Start of the part of the video that is used, s; default: start of the video")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_option("--to", o.to, "End of the part of the video that is used, s; default: end of the video")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
}

void add_threads_option(CLI::App* v, unsigned& threads) {
  v->add_option("--threads", threads,
                "Number of threads; default: all threads of the machine. Does not change the result")
      ->check(integers(1, 1024));
}

std::string in_seconds(std::string text) {
  try {
    const Quantity q = parse_quantity(text);
    return q.dimension == parse_unit("s").dimension ? fmt::format("{}", q.value) : text;
  } catch (const std::invalid_argument&) {
    return text;
  }
}

}  // namespace faba::cli
