#include "server/files/opened_input.h"

namespace faba {

Error renamed(const Error& e, const std::string& path, const std::string& name) {
  const auto shown = [&](std::string text) {
    for (std::size_t at = 0; (at = text.find(path, at)) != std::string::npos; at += name.size())
      text.replace(at, path.size(), name);
    return text;
  };
  return {e.code(), shown(e.where()), shown(e.reason())};
}

}  // namespace faba
