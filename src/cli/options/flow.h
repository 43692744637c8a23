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

/// Options of the optical flow: the flow part, its parameters as text, shrinking, frame rate and threads.
struct FlowOptions {
  std::string method = FlowChoice{}.method;
  std::vector<std::pair<std::string, std::string>> values;
  int shrink = 0;
  double fps = 0;
  unsigned threads = 0;
};
/// Definition of a response.
struct ResponseOptions {
  std::optional<double> direction, flow_threshold;
};

/// Adds --shrink, --fps, --threads, --method, and an option for every parameter of every flow part, from
/// their schemas. `defaults`: the values of the verb for parameters that are not given (flow_part), which the
/// help states.
void add_flow_options(CLI::App* v, FlowOptions& o, const FlowChoice& defaults = {});
/// Adds --direction and --flow-threshold.
void add_response_options(CLI::App* v, ResponseOptions& o);

/// For options in seconds: converts "1.2 s" and "300 ms" to a number; returns any other text unchanged.
std::string in_seconds(std::string text);

}  // namespace faba::cli
