#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vision/flow/flow.h"

namespace faba {

/// A flow part selected on the command line: its name and the given parameters as strings.
struct FlowChoice {
  std::string method = "horn_schunck";
  std::vector<std::pair<std::string, std::string>> values;  ///< such as {"alpha2", "30"}
};
/// The options of a choice, with --shrink and --fps where given: "--pyramid, --shrink".
std::string options_text(const FlowChoice& choice, int shrink, double fps);
/// The part. Parameters that are not given have the values of `defaults` if the method is the same, else the
/// defaults of the part. Throws Error(usage, "--alpha2") with the reason.
FlowRegistry::PartType flow_part(const FlowChoice& choice, const FlowChoice& defaults = {});
/// The published method: Horn and Schunck, 100 sweeps of Jacobi from zero (theory A22); the default of
/// activity() and compare(). A converged iteration would spread the flow of a cell over the background around
/// it.
FlowChoice published_flow();

}  // namespace faba
