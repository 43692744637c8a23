#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "study/motion/histogram_files.h"

#include <nlohmann/json.hpp>

namespace faba::cli {
namespace {

struct DistanceVerb {
  std::filesystem::path p, similarity;
  std::vector<std::filesystem::path> q;
  double m = 0.9, threshold = 3;
  bool normalise = false;
};

int distance(const DistanceVerb& v, const Common& c) {
  DistanceOptions o;
  o.m = v.m;
  o.threshold = v.threshold;
  o.similarity = v.similarity;
  o.normalise = v.normalise;
  const auto d = histogram_distances(v.p, v.q, o);
  if (c.json) {
    fmt::print("{}\n",
               nlohmann::ordered_json{{"distance", d}, {"m", v.m}, {"threshold", v.threshold}}.dump());
    return 0;
  }
  for (const double value : d) fmt::print("{:.17g}\n", value);
  return 0;
}

}  // namespace

void add_distance(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<DistanceVerb>();
  CLI::App* v = verb(
      app, line, "distance", "Quadratic-Chi distance of histograms in text files with one number per line",
      "  faba distance p.csv q.csv\n  faba distance p.csv q1.csv q2.csv --m 0.5 --threshold 20");
  v->add_option("p", o->p, "Histogram")->required();
  v->add_option("q", o->q, "Histograms to compare with P; one line of output for each")->required();
  v->add_option(
      "--m", o->m,
      fmt::format("Exponent of the normalisation, at least 0 and less than 1; default: {:g}", o->m));
  v->add_option(
      "--threshold", o->threshold,
      fmt::format("Distance of bins at which their similarity is zero; default: {:g}", o->threshold));
  v->add_option("--similarity", o->similarity,
                "Similarity matrix of the bins, as CSV, in place of --threshold")
      ->check(not_empty)
      ->excludes("--threshold");
  v->add_flag("--normalise", o->normalise,
              "First scale both histograms to a sum of 1, to compare shapes only");
  v->callback([o, &line] { line.code = distance(*o, line.common); });
}

}  // namespace faba::cli
