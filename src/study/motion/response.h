#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "study/motion/displacements.h"
#include "study/motion/onset.h"
#include "study/motion/pair_shifts.h"

namespace faba {

/// Part in which speed and fraction of the responding objects are measured: it starts kResponseWait after the
/// rise, because cells that leave an edge together overlap before, and has the length kResponsePart. s,
/// assumed.
inline constexpr double kResponseWait = 0.3, kResponsePart = 1.5;

/// Whether the optical flow of a video has a direction, from the displacement of the objects that respond.
struct FlowVerdict {
  double shift_px = 0;                      ///< displacement between consecutive frames, px of the video
  double object_px = 0;                     ///< full width at half maximum of an object, px
  std::optional<double> neighbour_px = {};  ///< mean distance to the nearest neighbour, px
  /// The flow of objects that move by more than twice their width between frames has no direction (theory
  /// A22).
  bool valid() const { return shift_px <= 2 * object_px; }
  /// Up to one width the flow of an object is its displacement; beyond, it is smaller, and for some objects
  /// opposite (theory A22, range).
  bool follows() const { return shift_px <= object_px; }
};

/// Response of the objects in a video to a field reversal (theory A16).
struct Response {
  enum class Source { given, recorded, detected };
  Source source = Source::given;  ///< of the time of the reversal
  double earliest_s = 0;          ///< the reversal, or the start of the search if it was detected
  double direction_deg = 0;       ///< of the motion after it
  std::string measure;            ///< of the displacements for the onset
  bool responds = false;          ///< whether the change of velocity is significant
  ChangePoint change;             ///< also without a response
  /// Without a response in a given direction: that of another significant change of the velocity.
  std::optional<double> other_direction_deg = {};
  std::string fraction_method;  ///< of `fraction`; empty when it is unknown
  /// Of the objects in view from 0.3 to 1.8 s after the rise, or of those and the objects in view before the
  /// reversal that swim the other way; 0: no response.
  std::optional<Measured> fraction;
  std::optional<Measured>
      speed_px_s;  ///< mean, in the direction in which they move, of the responding objects
  std::optional<FlowVerdict> flow;
  /// Contrast of the objects that stay beside the edge of a drop, relative to that of all objects.
  double still_at_edge = 0;
};

/// Input of measure_response().
struct ResponseJob {
  std::filesystem::path video;  ///< anything VideoReader reads
  VideoPart part;
  std::optional<double> reversal_s, direction_deg;
  double frame_s = 0;                  ///< median time between frames
  std::optional<double> objects = {};  ///< mean number in view, at least 2; for the error of the fraction
  unsigned threads = 0;
  std::function<void()> check = [] {};              ///< called for each frame that is read
  std::shared_ptr<ResponsePictures> pictures = {};  ///< that another reading has taken; may be empty
};

/// The part of the video that measure_response() reads.
VideoPart response_part(const ResponseJob& job);

/// Detects the response to the field reversal, or, when its time is not given, the largest change of the mean
/// velocity in the first 20 s of the part. Empty with too few frames before or after it.
std::optional<Response> measure_response(const ResponseJob& job);

}  // namespace faba
