#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "study/data/flow_choice.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// How flows are made: the flow part, the parameters given for it in words, and what comes before and beside
/// it.
struct FlowOptions {
  std::string method = FlowChoice{}.method;
  std::vector<std::pair<std::string, std::string>> values;
  int shrink = 0;
  double fps = 0;
  unsigned threads = 0;
};
/// What counts as a response.
struct ResponseOptions {
  std::optional<double> direction, flow_threshold;
};

/// --shrink, --fps, --threads, --method, and an option for every parameter of every flow part, as their
/// schemas describe them.
void add_flow_options(CLI::App* v, FlowOptions& o);
/// --direction and --flow-threshold
void add_response_options(CLI::App* v, ResponseOptions& o);

/// For options that are seconds: "1.2 s" and "300 ms" as the number that they are; other words stay.
std::string in_seconds(std::string word);

}  // namespace faba::cli
