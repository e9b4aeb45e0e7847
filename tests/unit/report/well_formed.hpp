// SPDX-License-Identifier: Apache-2.0
#pragma once
// well_formed: a small check of what an XML parser would refuse, for pages written here; count: of parts of a text.

#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace saccade::test {

/// Elements of a page, and the first thing wrong with it.
struct Markup {
  std::string problem;  ///< empty: none
  std::size_t elements{0};
  std::set<std::string> ids;
  std::vector<std::string> references;  ///< values of href and src
};

namespace markup {

inline bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == ':'; }

/// "&" begins one of the entities that XML knows, or a number.
inline bool entities_ok(std::string_view text) {
  for (std::size_t i = text.find('&'); i != std::string_view::npos; i = text.find('&', i + 1)) {
    const std::string_view name = text.substr(i + 1, text.find(';', i) - i - 1);
    if (name != "amp" && name != "lt" && name != "gt" && name != "quot" && name.substr(0, 1) != "#") return false;
  }
  return text.find('<') == std::string_view::npos;
}

/// Attributes of a tag from `i` on; returns what is wrong.
inline std::string read_attributes(std::string_view tag, std::size_t i, Markup& page) {
  std::set<std::string> names;
  while (i < tag.size()) {
    if (tag[i] != ' ') return "no space before an attribute";
    const std::size_t begin = ++i;
    while (i < tag.size() && is_name(tag[i])) ++i;
    const std::string name{tag.substr(begin, i - begin)};
    if (name.empty() || !names.insert(name).second) return "attribute without a name, or twice";
    if (tag.substr(i, 2) != "=\"") return "attribute without a quoted value: " + name;
    const std::size_t end = tag.find('"', i + 2);
    if (end == std::string_view::npos) return "open quotes";
    const std::string value{tag.substr(i + 2, end - i - 2)};
    if (!entities_ok(value)) return "bare markup in the attribute " + name;
    if (name == "id" && !page.ids.insert(value).second) return "id twice: " + value;
    if (name == "href" || name == "src") page.references.push_back(value);
    i = end + 1;
  }
  return {};
}

}  // namespace markup

/// Tags are balanced, attributes quoted and named once, ids unique, & and < escaped.
inline Markup well_formed(std::string_view text) {
  Markup page;
  const auto fail = [&](const std::string& why) {
    page.problem = why;
    return page;
  };
  constexpr std::string_view kDoctype{"<!DOCTYPE html>"};
  if (text.substr(0, kDoctype.size()) == kDoctype) text.remove_prefix(kDoctype.size());
  std::vector<std::string> open;
  while (!text.empty()) {
    const std::size_t begin = text.find('<');
    const std::string_view before = text.substr(0, begin);
    if (!markup::entities_ok(before)) return fail("bare & in text");
    if (open.empty() && before.find_first_not_of(" \n") != std::string_view::npos) return fail("text outside");
    if (begin == std::string_view::npos) break;
    const std::size_t end = text.find('>', begin);
    if (end == std::string_view::npos) return fail("open tag");
    std::string_view tag = text.substr(begin + 1, end - begin - 1);
    text.remove_prefix(end + 1);
    const bool closes = !tag.empty() && tag.front() == '/';
    const bool empty = !tag.empty() && tag.back() == '/';
    if (closes) tag.remove_prefix(1);
    if (empty) tag.remove_suffix(1);
    std::size_t i{0};
    while (i < tag.size() && markup::is_name(tag[i])) ++i;
    const std::string name{tag.substr(0, i)};
    if (closes) {
      if (open.empty() || open.back() != name || i != tag.size()) return fail("</" + name + "> closes nothing");
      open.pop_back();
      continue;
    }
    ++page.elements;
    const std::string wrong = markup::read_attributes(tag, i, page);
    if (name.empty() || !wrong.empty()) return fail("<" + name + ">: " + wrong);
    if (!empty) open.push_back(name);
  }
  return open.empty() ? page : fail("<" + open.back() + "> stays open");
}

/// How often a text has a part.
inline std::size_t count(std::string_view text, std::string_view part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size())) ++found;
  return found;
}

}  // namespace saccade::test
