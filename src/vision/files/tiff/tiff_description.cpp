#include "vision/files/tiff/tiff_description.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <string_view>
#include <utility>

#include "vision/files/tiff/xml_attributes.h"

namespace faba {
namespace {

constexpr double kMinScale = 1e-3, kMaxScale = 1e3;   // um/px, as in a scenario
constexpr double kMinRate = 1e-6, kMaxRate = 1e9;     // Hz
constexpr double kSquare = 0.01;                      // relative difference of the sides of a pixel
constexpr std::size_t kLargestCompanion = 16u << 20;  // bytes

using Attributes = std::map<std::string, std::string>;
using Unit = std::pair<std::string_view, double>;

// In UTF-8, in Latin-1, and as ImageJ escapes it; U+03BC is the Greek letter.
constexpr std::array<Unit, 16> kLengths{{{"\xC2\xB5m", 1},
                                         {"\xCE\xBCm", 1},
                                         {"\xB5m", 1},
                                         {"\\u00B5m", 1},
                                         {"um", 1},
                                         {"micron", 1},
                                         {"microns", 1},
                                         {"micrometer", 1},
                                         {"micrometre", 1},
                                         {"nm", 1e-3},
                                         {"pm", 1e-6},
                                         {"mm", 1e3},
                                         {"cm", 1e4},
                                         {"m", 1e6},
                                         {"nanometer", 1e-3},
                                         {"millimeter", 1e3}}};
constexpr std::array<Unit, 12> kTimes{{{"s", 1},
                                       {"sec", 1},
                                       {"second", 1},
                                       {"seconds", 1},
                                       {"ms", 1e-3},
                                       {"msec", 1e-3},
                                       {"\xC2\xB5s", 1e-6},
                                       {"\xCE\xBCs", 1e-6},
                                       {"us", 1e-6},
                                       {"min", 60},
                                       {"minute", 60},
                                       {"h", 3600}}};

template <std::size_t N>
std::optional<double> unit_of(const std::array<Unit, N>& units, std::string_view name) {
  for (const auto& [known, value] : units)
    if (name == known) return value;
  return std::nullopt;
}

// A finite number above zero that fills the text.
std::optional<double> positive(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  double value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

std::string value_of(const Attributes& attributes, const std::string& key, const std::string& otherwise) {
  const auto at = attributes.find(key);
  return at == attributes.end() ? otherwise : at->second;
}

// Metadata enter messages: at most 40 printable ASCII characters.
std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text.substr(0, 40)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + "\"";
}

void ignore(PictureMetadata& m, const std::string& what, const std::string& why) {
  if (m.ignored.empty()) m.ignored = fmt::format("the {} of the file is ignored: {}", what, why);
}

// Takes a pixel of `x` by `y` um.
void take_pixel(PictureMetadata& m, double x, double y) {
  if (std::fabs(y / x - 1) > kSquare)
    return ignore(m, "pixel size", fmt::format("its pixels are not square, {:.4g} x {:.4g} um", x, y));
  if (!(x >= kMinScale && x <= kMaxScale))
    return ignore(m, "pixel size", fmt::format("{:.3g} um per px is not between 0.001 and 1000", x));
  m.um_per_px = x;
}

void take_interval(PictureMetadata& m, const std::string& text, const std::string& unit) {
  const std::optional<double> interval = positive(text), seconds = unit_of(kTimes, unit);
  if (!seconds) return ignore(m, "frame interval", fmt::format("the unit {} is not known", in_quotes(unit)));
  if (!interval)
    return ignore(m, "frame interval", fmt::format("{} is not a number above 0", in_quotes(text)));
  const double fps = 1 / (*interval * *seconds);
  if (!(fps >= kMinRate && fps <= kMaxRate))
    return ignore(m, "frame interval", fmt::format("{:.3g} s is out of range", 1 / fps));
  m.fps = fps;
}

PictureMetadata ome_metadata(const Attributes& pixels) {
  PictureMetadata m;
  if (const auto x = pixels.find("PhysicalSizeX"); x != pixels.end()) {
    const std::string y = value_of(pixels, "PhysicalSizeY", x->second);
    const std::string unit_x = value_of(pixels, "PhysicalSizeXUnit", "um");  // default of the schema
    const std::string unit_y = value_of(pixels, "PhysicalSizeYUnit", unit_x);
    const std::optional<double> side_x = positive(x->second), side_y = positive(y),
                                um_x = unit_of(kLengths, unit_x), um_y = unit_of(kLengths, unit_y);
    if (!um_x || !um_y)
      ignore(m, "pixel size", fmt::format("the unit {} is not a length", in_quotes(um_x ? unit_y : unit_x)));
    else if (!side_x || !side_y)
      ignore(m, "pixel size", fmt::format("{} is not a number above 0", in_quotes(side_x ? y : x->second)));
    else
      take_pixel(m, *side_x * *um_x, *side_y * *um_y);
  }
  if (const auto t = pixels.find("TimeIncrement"); t != pixels.end())
    take_interval(m, t->second, value_of(pixels, "TimeIncrementUnit", "s"));
  return m;
}

// Lines of key=value.
Attributes lines_of(std::string_view text) {
  Attributes lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (const std::size_t equals = line.find('='); equals != std::string_view::npos)
      lines.emplace(line.substr(0, equals), line.substr(equals + 1));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

PictureMetadata imagej_metadata(const TiffDescription& d) {
  PictureMetadata m;
  const Attributes lines = lines_of(d.text);
  const std::string unit = value_of(lines, "unit", "");
  const bool stated = !unit.empty() && unit != "pixel" && unit != "pixels";
  if (const std::optional<double> um = unit_of(kLengths, unit)) {
    const double across = d.x_resolution, down = d.y_resolution > 0 ? d.y_resolution : across;
    if (across > 0 && std::isfinite(across) && std::isfinite(down))
      take_pixel(m, *um / across, *um / down);
    else
      ignore(m, "pixel size", "the resolution tag is missing or not a number above 0");
  } else if (stated) {
    ignore(m, "pixel size",
           unit == "inch" || unit == "inches" ? std::string("in inches it is a print resolution")
                                              : fmt::format("the unit {} is not a length", in_quotes(unit)));
  }
  // fps is the rate at which ImageJ plays the stack.
  if (const auto interval = lines.find("finterval"); interval != lines.end())
    take_interval(m, interval->second, value_of(lines, "tunit", "s"));
  const std::optional<double> playback = positive(value_of(lines, "fps", ""));
  if (!(m.fps > 0) && playback && *playback >= kMinRate && *playback < kMaxRate) m.fps = *playback;
  return m;
}

std::string text_of(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(file, failure) ||
      std::filesystem::file_size(file, failure) > kLargestCompanion)
    return {};
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// OME-XML of a companion file in the folder of the picture; empty if not found.
std::string companion_text(const std::string& named, const std::filesystem::path& picture) {
  std::filesystem::path stem = picture.stem();
  if (stem.extension() == ".ome") stem = stem.stem();
  for (const std::string& name : {std::filesystem::path(named).filename().string(),
                                  stem.string() + ".companion.ome", stem.string() + ".ome.xml"}) {
    if (name.empty()) continue;
    if (std::string text = text_of(picture.parent_path() / name); !text.empty()) return text;
  }
  return {};
}

}  // namespace

PictureMetadata tiff_metadata(const TiffDescription& d, const std::filesystem::path& picture) {
  if (d.text.starts_with("ImageJ=")) return imagej_metadata(d);
  if (Attributes pixels = xml_attributes(d.text, "Pixels"); !pixels.empty()) return ome_metadata(pixels);
  const std::string named = value_of(xml_attributes(d.text, "BinaryOnly"), "MetadataFile", "");
  return ome_metadata(xml_attributes(companion_text(named, picture), "Pixels"));
}

}  // namespace faba
