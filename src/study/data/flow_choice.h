#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vision/flow/flow.h"

namespace faba {

/// A flow part as the command line names it: its name and the parameters that were given, in words.
struct FlowChoice {
  std::string method = "horn_schunck";
  std::vector<std::pair<std::string, std::string>> values;  ///< such as {"alpha2", "30"}
};
/// The options that a choice came from, with --shrink and --fps where they were given: "--pyramid, --shrink".
std::string options_text(const FlowChoice& choice, int shrink, double fps);
/// The part. Parameters that are not given have the values of `defaults`, and else the part's own; a method
/// that is not that of `defaults` takes nothing from there. Throws Error(usage, "--alpha2") with the reason.
FlowRegistry::PartType flow_part(const FlowChoice& choice, const FlowChoice& defaults = {});
/// The published measure: Horn and Schunck, 100 sweeps of Jacobi from zero (theory A22). What activity() and
/// compare() take unless told otherwise: with the iteration carried to the end the flow of a cell would
/// spread over the empty ground around it.
FlowChoice published_flow();

}  // namespace faba
