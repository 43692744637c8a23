#include "vision/draw/disc_sprites.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/draw/fixed_point.h"

namespace faba {
namespace {

constexpr int kOffsets = 1 << kShift;  // positions within a pixel, along each axis

std::uint8_t blended(std::uint8_t ground, std::uint8_t colour, int coverage) {
  return std::uint8_t((ground * (255 - coverage) + colour * coverage + 127) / 255);
}

}  // namespace

DiscSprites::DiscSprites(double radius_px) : side_(2 * int(std::ceil(radius_px + 1)) + 1) {
  constexpr int kMargin = 8;  // px; near a border OpenCV draws other discs
  const int radius = std::max(1, fixed_length(radius_px)), middle = kMargin + side_ / 2;
  const std::size_t size = std::size_t(side_) * std::size_t(side_);
  coverage_.resize(std::size_t{kOffsets} * std::size_t{kOffsets} * size);
  cv::Mat large(side_ + 2 * kMargin, side_ + 2 * kMargin, CV_8UC1);
  std::uint8_t* sprite = coverage_.data();
  for (int y = 0; y < kOffsets; ++y)
    for (int x = 0; x < kOffsets; ++x, sprite += size) {
      large.setTo(0);
      cv::circle(large, {middle * kOffsets + x, middle * kOffsets + y}, radius, 255, cv::FILLED, cv::LINE_AA,
                 kShift);
      cv::Mat m(side_, side_, CV_8UC1, sprite);
      large(cv::Rect(kMargin, kMargin, side_, side_)).copyTo(m);
    }
}

void DiscSprites::draw(RgbImage& picture, double x, double y, Rgb colour) const {
  const cv::Point at = fixed_point({x, y});
  const int left = (at.x >> kShift) - side_ / 2, top = (at.y >> kShift) - side_ / 2;
  const int part = (at.y & (kOffsets - 1)) * kOffsets + (at.x & (kOffsets - 1));
  const std::uint8_t* sprite = coverage_.data() + std::ptrdiff_t(part) * side_ * side_;
  const int first_row = std::max(0, -top), end_row = std::min(side_, picture.height - top);
  const int first = std::max(0, -left), end = std::min(side_, picture.width - left);
  for (int row = first_row; row < end_row; ++row) {
    const std::uint8_t* coverage = sprite + std::ptrdiff_t(row) * side_;
    Rgb* to = picture.px.data() + std::ptrdiff_t(top + row) * picture.width + left;
    for (int column = first; column < end; ++column) {
      const int c = coverage[column];
      if (c == 0) continue;
      to[column] = {blended(to[column].r, colour.r, c), blended(to[column].g, colour.g, c),
                    blended(to[column].b, colour.b, c)};
    }
  }
}

}  // namespace faba
