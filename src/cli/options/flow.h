#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/options/video_part.h"
#include "study/data/flow_choice.h"

namespace CLI {
class App;
}

namespace faba::cli {

/// Options of the optical flow: the flow part, its parameters as text, shrinking, frame rate, part of the
/// video and threads.
struct FlowOptions {
  std::string method = FlowChoice{}.method;
  std::vector<std::pair<std::string, std::string>> values;
  int shrink = 0;
  double fps = 0;
  PartOptions part;
  unsigned threads = 0;
};
/// Definition of a response.
struct ResponseOptions {
  std::optional<double> direction, flow_threshold;
};

/// Adds --shrink, --fps, --from, --to, --threads, --method, and an option for every parameter of every flow
/// part, from their schemas. `defaults`: the values of the verb for parameters that are not given
/// (flow_part), which the help states.
void add_flow_options(CLI::App* v, FlowOptions& o, const FlowChoice& defaults = {});
/// Adds --direction and --flow-threshold.
void add_response_options(CLI::App* v, ResponseOptions& o);

}  // namespace faba::cli
