#pragma once

namespace faba {

/// Codec and container of a recording, while it is written and when it is complete.
enum class VideoFormat {
  mp4,           ///< H.264 in MP4: small, plays in every browser, lossy (constant quality, crf 20)
  lossless_avi,  ///< PNG frames in AVI: lossless, opens in Fiji and ImageJ; for measurements
};

/// Pixel type of a recording. mp4 stores grey pictures as 8-bit luma.
enum class VideoPixels {
  colour,  ///< RgbImage
  grey8,   ///< Gray8
  grey16,  ///< Image<std::uint16_t>; lossless_avi only
};

/// Frame rate as a fraction: numerator / denominator frames per second, both positive.
struct FrameRate {
  int numerator = 25, denominator = 1;
};

inline constexpr int kMaxVideoSide = 16384;                          ///< px, limit of H.264
inline constexpr double kMinFrameRate = 0.001, kMaxFrameRate = 1e4;  ///< frames per second

/// Nearest fraction to `fps` with numerator and denominator up to 100 000 (15/1, 273/20 for 13.65, 2997/50
/// for 59.94; 30000/1001 for 29.97003). Throws Error(Errc::internal) unless 0.001 <= fps <= 10 000.
FrameRate frame_rate_near(double fps);

}  // namespace faba
