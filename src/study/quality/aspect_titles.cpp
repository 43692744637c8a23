#include <algorithm>
#include <map>

#include "study/quality/quality.h"

namespace faba {
namespace {

const std::map<std::string_view, const char*>& titles() {
  static const std::map<std::string_view, const char*> all = {
      {"alignment", "Alignment in time"},
      {"aperture", "Aperture problem"},
      {"arc", "Visible arc of the edge"},
      {"axis", "Axes of the table"},
      {"blur", "Motion blur"},
      {"coding", "Compression of the video"},
      {"contrast", "Contrast of the motion"},
      {"coverage", "Coverage of the intervals"},
      {"crowding", "Density of the cells"},
      {"detection", "Detection of the cells"},
      {"direction", "Direction"},
      {"displacement", "Displacement between frames"},
      {"drag", "Drag of the cells"},
      {"drift", "Drift of the sample or the stage"},
      {"edge", "Cells at the edge of the drop"},
      {"edges", "Several edges in the picture"},
      {"experiments", "Number of experiments"},
      {"failed", "Failed experiments"},
      {"field", "Alignment with the field"},
      {"field_strength", "Field strength"},
      {"fit", "Fit of the model"},
      {"focus", "Focus"},
      {"frame_rate", "Frame rate"},
      {"frames", "Number of frames"},
      {"gain", "Gain of the coils"},
      {"iteration", "Convergence of the optical flow"},
      {"light", "Brightness of the frames"},
      {"linearity", "Linearity of the readings"},
      {"linking", "Links between detections"},
      {"marks", "Marks of the ruler"},
      {"method", "Method of the optical flow"},
      {"model", "Model of the motion"},
      {"motile_fraction", "Motile fraction"},
      {"noise", "Noise of the video"},
      {"outline", "Outline of the edge"},
      {"parameter", "Parameter of the model"},
      {"points", "Measured points"},
      {"polarity", "Polarity of the cells"},
      {"populations", "Several populations of cells"},
      {"radius", "Radius of the drop"},
      {"readings", "Readings of the ruler"},
      {"residual", "Deviation from the coil system"},
      {"response", "Cells that do not turn"},
      {"responsive_fraction", "Responsive fraction"},
      {"reversal", "Field reversal"},
      {"sample", "Number of cells"},
      {"saturation", "Range of the probe"},
      {"scale", "Scale of the picture"},
      {"search", "Search for the parameters"},
      {"shape", "Shape of the edge"},
      {"signal", "Field of the coils in the table"},
      {"size", "Size"},
      {"speed_spread", "Spread of the speeds"},
      {"texture", "Texture of the picture"},
      {"threshold", "Threshold of the optical flow"},
      {"tilt", "Plane of the turns"},
      {"timing", "Times of the field"},
      {"turning", "Turning of the cells"},
      {"turns", "Number of turns"},
      {"units", "Units of the table"},
      {"view", "Field of view"},
  };
  return all;
}

}  // namespace

std::string title_of_aspect(const std::string& aspect) {
  const auto found = titles().find(aspect);
  if (found != titles().end()) return found->second;
  std::string words = aspect;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

}  // namespace faba
