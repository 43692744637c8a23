#include "server/api/responses.h"

#include <map>

#include "server/json_text.h"

namespace faba {

WebResponse json_answer(const Json& j) { return {.body = json_text(j)}; }

WebResponse file_answer(const std::filesystem::path& file) {
  return {.type = content_type(file), .body = {}, .file = file};
}

WebResponse output_answer(const std::filesystem::path& file) {
  WebResponse answer = file_answer(file);
  answer.report = true;
  // The page runs scripts of this server; those of the user's files are not among them.
  const std::string extension = file.extension().string();
  if (extension == ".js" || extension == ".css") answer.type = "text/plain; charset=utf-8";
  return answer;
}

WebResponse picture_answer(const std::filesystem::path& file) {
  return {.type = "image/png", .body = {}, .file = file, .keep = true};
}

const char* content_type(const std::filesystem::path& file) {
  static const std::map<std::string, const char*> kTypes = {{".html", "text/html; charset=utf-8"},
                                                            {".js", "text/javascript; charset=utf-8"},
                                                            {".css", "text/css; charset=utf-8"},
                                                            {".svg", "image/svg+xml"},
                                                            {".png", "image/png"},
                                                            {".mp4", "video/mp4"},
                                                            {".json", "application/json"},
                                                            {".csv", "text/csv; charset=utf-8"},
                                                            {".toml", "text/plain; charset=utf-8"},
                                                            {".h5", "application/x-hdf5"},
                                                            {".avi", "video/x-msvideo"}};
  const auto it = kTypes.find(file.extension().string());
  return it == kTypes.end() ? "application/octet-stream" : it->second;
}

}  // namespace faba
