#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/command_line.h"
#include "cli/options/engine.h"
#include "cli/options/flow.h"
#include "study/motion/activity.h"

namespace faba::cli {

/// The options of `faba activity`.
struct ActivityVerb {
  std::vector<std::filesystem::path> videos;  ///< or one study file
  std::filesystem::path noise, out, report, picture;
  std::filesystem::path folder;  ///< of the study, with an engine
  ResponseOptions response;
  std::optional<double> reversal;  ///< s
  FlowOptions flow;
  bool force = false;
  EngineOptions engine;
};

/// Adds the options of the verb.
void add_activity_options(CLI::App* v, ActivityVerb& o);
/// The videos and settings of the verb and its study file.
ActivityJob job_of(const ActivityVerb& v);
/// The inputs of the verb, in the order of the provenance.
std::vector<std::filesystem::path> inputs_of(const ActivityVerb& v, const ActivityJob& job);
/// Prints the results as text.
void print_activity(const ActivityResult& result);
/// Measures the videos by an engine, with the outputs of the verb.
int activity_on_engine(const ActivityVerb& v, const Common& c);

}  // namespace faba::cli
