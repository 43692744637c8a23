#pragma once
#include <cstdint>
#include <vector>

namespace faba {

// What Foreground does to every pixel, in loops that the compiler makes vectors of. Same bits on every
// machine.

void to_float(const std::uint8_t* picture, float* out, int n);

/// Marks every pixel within `reach` of a marked one, in a square. `work` is memory that is used again.
void dilate(std::vector<std::uint8_t>& mask, std::vector<std::uint8_t>& work, int width, int height,
            int reach);

/// out = sign (picture - gain background)
void difference(const float* picture, const float* background, float gain, float sign, float* out, int n);

/// mask = v > threshold
void above(const float* v, float threshold, std::uint8_t* mask, int n);

/// peak = 1 where v is covered and larger than its eight neighbours, or as large as those before it; rows are
/// `width` apart. Else 0.
void mark_peaks(const float* v, int width, const std::uint8_t* covered, std::uint8_t* peak, int n);

/// Where covered: weights = level (-log(left) - (noise / light)^2 / 2), light = gain background, at least
/// one grey, left = picture / light, at least one grey or 2 % of it: noise alone makes the mean logarithm
/// smaller by half its square. Elsewhere weights stay.
struct LightLoss {
  float gain, noise, level;
};
void lost_light(const float* picture, const float* background, const std::uint8_t* covered,
                const LightLoss& p, float* weights, int n);

/// v = 0 where not covered
void clear_uncovered(const std::uint8_t* covered, float* v, int n);

/// Bit of a pixel's guess: this picture has proved it wrong.
constexpr std::uint8_t kProvedWrong = 4;

/// The background follows the picture: background = next (background + rate (back picture - background)), the
/// rate being `at_once` where weight or smooth are below their bounds, and then guess = 0, or where the
/// guess was proved wrong; else `absorb` where covered, `follow` elsewhere. kProvedWrong is taken off.
struct Following {
  float follow, absorb, at_once;
  float least_weight, least_smooth;
  float back, next;
};
void follow_picture(const float* picture, const float* weights, const float* smooth,
                    const std::uint8_t* covered, const Following& p, std::uint8_t* guess, float* background,
                    int n);

}  // namespace faba
