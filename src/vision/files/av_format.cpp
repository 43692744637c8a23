#include "vision/files/av_format.h"
#include "vision/files/ffmpeg.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace faba {

bool is_refused_format(std::string_view kind) {
  constexpr std::array<std::string_view, 12> kRefused = {
      "tty", "bin", "xbin", "adf", "idf", "rawvideo", "hls", "concat", "dash", "applehttp", "sdp", "imf"};
  return std::find(kRefused.begin(), kRefused.end(), kind) != kRefused.end();
}

bool is_still(std::string_view kind) { return kind.ends_with("_pipe") || kind == "image2"; }

bool is_avi_truncated(const std::filesystem::path& path) {
  std::array<unsigned char, 8> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(head.data()), head.size())) return false;
  std::uint64_t stated = 8;
  for (unsigned i = 0; i < 4; ++i) stated += std::uint64_t{head[4 + i]} << (8 * i);
  return stated > std::filesystem::file_size(path) + 1;  // the last chunk may lack its padding byte
}

// The markers FF DA (start of scan) and FF D9 (end of image) cannot occur inside entropy-coded data.
bool is_jpeg_truncated(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const auto scan = bytes.rfind("\xFF\xDA");
  return scan == std::string::npos || bytes.find("\xFF\xD9", scan) == std::string::npos;
}

const AVInputFormat* portable_map(AVIOContext& io) {
  unsigned char magic[3] = {};
  const int read = FABA_AV(avio_read)(&io, magic, 3);
  FABA_AV(avio_seek)(&io, 0, SEEK_SET);
  if (read < 3 || magic[0] != 'P' || std::isspace(magic[2]) == 0) return nullptr;
  return magic[1] == '5'   ? FABA_AV(av_find_input_format)("pgm_pipe")
         : magic[1] == '6' ? FABA_AV(av_find_input_format)("ppm_pipe")
                           : nullptr;
}

}  // namespace faba
