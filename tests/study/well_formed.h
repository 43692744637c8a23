#pragma once
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace faba::test {

/// Says what is wrong with an XML text; empty when nothing is. Checks that tags nest and close, that
/// attributes are quoted and named once, that no < or bare & is left in the text. Knows no DTD, comments or
/// CDATA: our writers make none.
class XmlCheck {
 public:
  static std::string complaint(std::string_view xml) {
    XmlCheck check(xml);
    check.document();
    return check.complaint_;
  }

 private:
  explicit XmlCheck(std::string_view xml) : rest_(xml) {}

  void fail(const std::string& what) {
    if (complaint_.empty()) complaint_ = what + " before: " + std::string(rest_.substr(0, 60));
    rest_ = {};
  }
  std::string_view take_until(std::string_view stop) {
    const auto at = rest_.find_first_of(stop);
    const std::string_view taken = rest_.substr(0, at);
    rest_.remove_prefix(taken.size());
    return taken;
  }
  void check_references(std::string_view text) {
    for (auto at = text.find('&'); at != std::string_view::npos; at = text.find('&', at + 1)) {
      const std::string_view name = text.substr(at + 1, text.find(';', at) - at - 1);
      if (name != "amp" && name != "lt" && name != "gt" && name != "quot" && name != "#39") fail("bare &");
    }
  }
  void space() {
    while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front()))) rest_.remove_prefix(1);
  }
  void attributes() {
    std::vector<std::string_view> seen;
    for (space(); !rest_.empty() && rest_.front() != '>' && rest_.front() != '/'; space()) {
      const std::string_view name = take_until("=<> \n");
      for (const std::string_view other : seen) {
        if (other == name) return fail("attribute twice");
      }
      seen.push_back(name);
      if (name.empty() || !rest_.starts_with("=\"")) return fail("attribute without quoted value");
      rest_.remove_prefix(2);
      check_references(take_until("\"<"));
      if (!rest_.starts_with('"')) return fail("open quote");
      rest_.remove_prefix(1);
      if (!rest_.empty() && std::string_view(" \n/>").find(rest_.front()) == std::string_view::npos) {
        return fail("no space between attributes");
      }
    }
  }
  void tag() {
    const bool closing = rest_.starts_with('/');
    if (closing) rest_.remove_prefix(1);
    const std::string name(take_until(" />\n"));
    if (name.empty() || !std::isalpha(static_cast<unsigned char>(name.front())))
      return fail("tag without name");
    if (closing) {
      if (open_.empty() || open_.back() != name) return fail("</" + name + "> closes nothing");
      open_.pop_back();
      if (open_.empty()) closed_root_ = true;
    } else {
      if (open_.empty() && closed_root_) return fail("second root <" + name + ">");
      attributes();
      if (rest_.starts_with('/'))
        rest_.remove_prefix(1);
      else
        open_.push_back(name);
    }
    if (!rest_.starts_with('>')) return fail("tag without end");
    rest_.remove_prefix(1);
  }
  void document() {
    if (rest_.starts_with("<!DOCTYPE html>")) rest_.remove_prefix(15);
    while (complaint_.empty() && !rest_.empty()) {
      const std::string_view text = take_until("<");
      check_references(text);
      if (open_.empty() && text.find_first_not_of(" \n") != std::string_view::npos)
        fail("text outside of the root");
      if (rest_.empty()) break;
      rest_.remove_prefix(1);
      tag();
    }
    if (complaint_.empty() && !open_.empty()) fail("<" + open_.back() + "> is not closed");
    if (complaint_.empty() && !closed_root_) fail("no element");
  }

  std::string_view rest_;
  std::string complaint_;
  std::vector<std::string> open_;
  bool closed_root_ = false;
};

}  // namespace faba::test
