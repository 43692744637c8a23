#pragma once

namespace faba {

/// How a recording is coded, while it grows and when it is finished.
enum class VideoFormat {
  mp4,           ///< H.264 in MP4: small, plays in every browser, nearly exact (constant quality, crf 20)
  lossless_avi,  ///< PNG frames in AVI: exact, opens in Fiji and ImageJ; for measuring on
};

/// What pixels a recording is made of. In mp4 greys are coded as luma of 8 bits, whichever they are.
enum class VideoPixels {
  colour,  ///< RgbImage
  grey8,   ///< Gray8
  grey16,  ///< Image<std::uint16_t>; lossless_avi only
};

/// A frame rate as a fraction, numerator / denominator frames per second, both positive.
struct FrameRate {
  int numerator = 25, denominator = 1;
};

inline constexpr int kLongestVideoSide = 16384;                      ///< px, what H.264 can hold
inline constexpr double kSlowestVideo = 0.001, kFastestVideo = 1e4;  ///< frames per second

/// The fraction with parts up to 100 000 that is nearest to `fps` (15/1, 273/20 for 13.65, 2997/50 for 59.94;
/// 30000/1001 for 29.97003). Throws Error(Errc::internal) unless 0.001 <= fps <= 10 000.
FrameRate frame_rate_near(double fps);

}  // namespace faba
