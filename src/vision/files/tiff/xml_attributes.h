#pragma once
#include <map>
#include <string>
#include <string_view>

namespace faba {

/// The attributes of the first element `element` (without namespace prefix) of an XML text, decoded to UTF-8;
/// empty if not found. Reads attributes only, without a parser: text, comments, CDATA and document types
/// are skipped, the predefined and numeric character references are replaced once, other entities stay as
/// they are, so a hostile document cannot expand. An element that is not closed is ignored. O(length).
std::map<std::string, std::string> xml_attributes(std::string_view xml, std::string_view element);

}  // namespace faba
