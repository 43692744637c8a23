#pragma once
#include <cstdint>
#include <vector>

namespace faba {

// Pixel operations of Foreground in vectorised loops. Bit-identical on every machine.

void to_float(const std::uint8_t* picture, float* out, int n);

/// Dilates the mask by a square of half width `reach`. `work` is scratch memory.
void dilate(std::vector<std::uint8_t>& mask, std::vector<std::uint8_t>& work, int width, int height,
            int reach);

/// out = sign (picture - gain background)
void difference(const float* picture, const float* background, float gain, float sign, float* out, int n);

/// mask = v > threshold
void above(const float* v, float threshold, std::uint8_t* mask, int n);

/// peak = 1 where v is covered and is a local maximum of its 8-neighbourhood (>= the previous neighbours, >
/// the next ones), else 0; rows are `width` apart.
void mark_peaks(const float* v, int width, const std::uint8_t* covered, std::uint8_t* peak, int n);

/// Where covered: weights = level (-log(left) - (noise / light)^2 / 2), with light = gain background (at
/// least one grey) and left = picture / light (at least one grey or 2 % of light); the second term corrects
/// the bias of the mean logarithm by noise. Elsewhere weights are not changed.
struct LightLoss {
  float gain, noise, level;
};
void lost_light(const float* picture, const float* background, const std::uint8_t* covered,
                const LightLoss& p, float* weights, int n);

/// v = 0 where not covered
void clear_uncovered(const std::uint8_t* covered, float* v, int n);

/// Flag of a pixel: its guessed background was disproved by this picture.
constexpr std::uint8_t kDisproved = 4;

/// Background update: background = next (background + rate (back picture - background)). The rate is
/// `at_once` where weight or smooth are below their bounds (then guess = 0) or where the guess was disproved;
/// else `absorb` where covered and `follow` elsewhere. kDisproved is cleared.
struct Following {
  float follow, absorb, at_once;
  float least_weight, least_smooth;
  float back, next;
};
void follow_picture(const float* picture, const float* weights, const float* smooth,
                    const std::uint8_t* covered, const Following& p, std::uint8_t* guess, float* background,
                    int n);

}  // namespace faba
