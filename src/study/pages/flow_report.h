#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/data/flow_choice.h"
#include "study/flow/flow_measurement.h"

namespace faba {

/// What `faba flow` is asked for.
struct FlowJob {
  FlowRegistry::PartType method;
  std::filesystem::path out;      ///< .flo for a pair, .h5 for a video; not written when empty
  std::filesystem::path picture;  ///< of a pair: in colours, PNG
  std::filesystem::path truth;    ///< of a pair: the true flow, .flo
  std::filesystem::path overlay;  ///< of a video: arrows on its frames, MP4
  int shrink = 0;                 ///< see FlowSourceOptions
  double fps = 0;                 ///< see FlowSourceOptions
  std::string options_text = {};  ///< see FlowSourceOptions
  bool compress = true;           ///< of .h5
  unsigned threads = 0;           ///< 0: all
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// Measures the flow from one picture to another and writes the files that are named. Throws Error(input).
PairFlow flow_of_pair(const std::filesystem::path& a, const std::filesystem::path& b, const FlowJob& job);

/// Measures the flows of a video (or of a run's) and writes the files that are named, each when it is
/// complete. Throws Error(input), and Error(interrupted) when stopped.
VideoFlow flow_of_video(const std::filesystem::path& video, const FlowJob& job);

/// `{"image_size":[w,h],"method":{..},"iterations":n,"converged":b,"mean_px":[u,v],"mean_speed_px":..,"largest_px":..,
/// "truth":{"endpoint_px":..,"angular_deg":..,"known":fraction},"notes":[..]}`; `iterations` and `converged`
/// where the method has them, `truth` when it was given.
nlohmann::ordered_json flow_json(const PairFlow& flow);

/// `{"image_size":[w,h],"method":{..},"pairs":n,"seconds":..,"mean_speed_px":.., "notes":[..]}`.
nlohmann::ordered_json flow_json(const VideoFlow& flow);

}  // namespace faba
