#include "vision/draw/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "vision/draw/fixed_point.h"

namespace faba {
namespace {

constexpr double kTileWidth = 640, kMostEnlarged = 3;
constexpr int kSheetGap = 8, kSheetLine = 24;  // px, between the frames and of a line of text
const cv::Scalar kSheetPaper(255, 255, 255), kSheetText(30, 30, 30), kSheetRing(213, 94, 0),
    kRegionInk(0, 114, 178);

void print_text(cv::Mat3b& sheet, const std::string& text, cv::Point at, double size) {
  cv::putText(sheet, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kSheetText, 1, cv::LINE_AA);
}

// The frame in grey levels, scaled; as three channels.
cv::Mat3b tile_of(const GrayF& picture, const SheetStyle& style, cv::Size size) {
  const float gain = style.white > style.black ? 255 / (style.white - style.black) : 0;
  cv::Mat3b grey(picture.height, picture.width);
  std::transform(picture.px.begin(), picture.px.end(), grey.begin(), [&](float v) {
    const auto g = std::uint8_t(std::lround(std::clamp((v - style.black) * gain, 0.0F, 255.0F)));
    return cv::Vec3b(g, g, g);
  });
  cv::Mat3b out;
  cv::resize(grey, out, size, 0, 0, size.width < picture.width ? cv::INTER_AREA : cv::INTER_LINEAR);
  return out;
}

}  // namespace

RgbImage contact_sheet(const std::vector<SheetFrame>& frames, const SheetStyle& style) {
  if (frames.empty() || frames.front().picture.empty()) return {};
  const GrayF& first = frames.front().picture;
  const double scale = std::min(kTileWidth / first.width, kMostEnlarged);
  const cv::Size tile(std::max(1, int(scale * first.width)), std::max(1, int(scale * first.height)));
  const int columns = std::min(style.columns, int(frames.size()));
  const int rows = (int(frames.size()) + columns - 1) / columns;
  cv::Mat3b sheet(kSheetLine + kSheetGap + rows * (tile.height + kSheetLine + kSheetGap),
                  kSheetGap + columns * (tile.width + kSheetGap));
  sheet.setTo(kSheetPaper);
  print_text(sheet, style.title, {kSheetGap, kSheetLine - 6}, 0.55);
  // Pixel centres are at integers before and after scaling.
  const auto scaled = [&](double x, double y) {
    return fixed_point({scale * (x + 0.5) - 0.5, scale * (y + 0.5) - 0.5});
  };
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const cv::Point corner(
        kSheetGap + (int(i) % columns) * (tile.width + kSheetGap),
        kSheetLine + kSheetGap + (int(i) / columns) * (tile.height + kSheetLine + kSheetGap));
    cv::Mat3b picture = tile_of(frames[i].picture, style, tile);
    for (const Vec2 at : frames[i].marks)
      cv::circle(picture, scaled(at.x, at.y), fixed_length(std::max(4.0, scale * style.ring_px)), kSheetRing,
                 1, cv::LINE_AA, kShift);
    const PixelRegion& r = style.region;
    if (r.width < first.width || r.height < first.height)
      cv::rectangle(picture, scaled(r.col - 0.5, r.row - 0.5),
                    scaled(r.col + r.width - 0.5, r.row + r.height - 0.5), kRegionInk, 1, cv::LINE_AA,
                    kShift);
    picture.copyTo(sheet(cv::Rect(corner, tile)));
    print_text(sheet, frames[i].caption, {corner.x, corner.y + tile.height + kSheetLine - 8}, 0.5);
  }
  RgbImage out(sheet.cols, sheet.rows);
  std::transform(sheet.begin(), sheet.end(), out.px.begin(), [](const cv::Vec3b& v) {
    return Rgb{v[0], v[1], v[2]};
  });
  return out;
}

}  // namespace faba
