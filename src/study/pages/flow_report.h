#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/data/flow_choice.h"
#include "study/flow/flow_measurement.h"

namespace faba {

/// Configuration of `faba flow`.
struct FlowJob {
  FlowRegistry::PartType method;
  std::filesystem::path out;      ///< .flo for a pair, .h5 for a video; not written when empty
  std::filesystem::path picture;  ///< for a pair: flow as colours, PNG
  std::filesystem::path truth;    ///< for a pair: true flow, .flo
  std::filesystem::path overlay;  ///< for a video: arrows on its frames, MP4
  int shrink = 0;                 ///< see FlowSourceOptions
  double fps = 0;                 ///< see FlowSourceOptions
  double from_s = 0;              ///< of a video: start of the interval
  std::optional<double> to_s;     ///< and its end
  std::string options_text = {};  ///< see FlowSourceOptions
  unsigned threads = 0;           ///< 0: all cores
  std::function<void(std::uint64_t done, std::uint64_t total)> progress = [](auto, auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// Measures the flow between two pictures and writes the requested files. Throws Error(input).
PairFlow flow_of_pair(const std::filesystem::path& a, const std::filesystem::path& b, const FlowJob& job);

/// Measures the flows of a video or of the video of a run and writes the requested files when they are
/// complete. Throws Error(input), and Error(interrupted) when stopped.
VideoFlow flow_of_video(const std::filesystem::path& video, const FlowJob& job);

/// `{"image_size":[w,h],"method":{..},"iterations":n,"converged":b,"mean_px":[u,v],"mean_speed_px":..,"largest_px":..,
/// "truth":{"endpoint_px":..,"angular_deg":..,"known":fraction},"notes":[..]}`; `iterations` and `converged`
/// for iterative methods, `truth` when a true flow is given.
nlohmann::ordered_json flow_json(const PairFlow& flow);

/// `{"image_size":[w,h],"method":{..},"pairs":n,"seconds":..,"mean_speed_px":.., "notes":[..]}`.
nlohmann::ordered_json flow_json(const VideoFlow& flow);

}  // namespace faba
