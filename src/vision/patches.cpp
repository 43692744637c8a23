#include "vision/patches.h"

#include <opencv2/imgproc.hpp>

namespace faba {

int label_patches(const std::vector<std::uint8_t>& mask, int width, int height, std::vector<int>& labels) {
  labels.resize(mask.size());
  if (mask.empty()) return 0;
  // OpenCV has no read-only matrices; the mask is not written to.
  const cv::Mat in(height, width, CV_8U, const_cast<std::uint8_t*>(mask.data()));
  cv::Mat out(height, width, CV_32S, labels.data());
  return cv::connectedComponents(in, out, 8, CV_32S) - 1;
}

}  // namespace faba
