// SPDX-License-Identifier: Apache-2.0
#pragma once
// TextMutator: damages files as mistakes and bad disks do.

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace saccade::test {

/// Makes one to three changes at random: a number replaced by one that is hard to read or to hold, a byte changed, a
/// part left out, repeated or moved, the end cut off. Equal seeds give equal changes.
class TextMutator {
 public:
  explicit TextMutator(std::uint64_t seed) : random_{seed} {}

  [[nodiscard]] std::string operator()(std::string text) {
    const std::size_t changes = 1 + below(3);
    for (std::size_t i = 0; i < changes && !text.empty(); ++i) change(text);
    return text;
  }

 private:
  void change(std::string& text) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(below(2) == 0 ? 4 : 80);
    switch (below(8)) {
      case 0:
      case 1:
      case 2: replace_number(text); break;
      case 3: text[at] = static_cast<char>(below(256)); break;
      case 4: text.erase(at, length); break;
      case 5: text.insert(below(text.size()), text.substr(at, length)); break;
      case 6: repeat(text, at, length); break;
      default: text.resize(at); break;
    }
  }
  void replace_number(std::string& text) {
    constexpr std::string_view kNumbers[]{"nan",  "-inf", "1e999", "-1e308", "1e20", "1e9", "4294967295", "-1",
                                          "1e-9", "0",    "-0",    "abc",    "1,5",  "",    "0x10"};
    constexpr std::string_view kDigits{"0123456789.-"};
    const std::size_t begin = text.find_first_of(kDigits, below(text.size()));
    if (begin == std::string::npos) return;
    const std::size_t end = text.find_first_not_of(kDigits, begin);
    text.replace(begin, end == std::string::npos ? end : end - begin, kNumbers[below(std::size(kNumbers))]);
  }
  void repeat(std::string& text, std::size_t at, std::size_t length) {
    const std::string part = text.substr(at, length);
    const std::size_t times = 1 + below(20);
    for (std::size_t i = 0; i < times; ++i) text.insert(at, part);
  }
  [[nodiscard]] std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>{0, end - 1}(random_);
  }

  std::mt19937_64 random_;
};

}  // namespace saccade::test
