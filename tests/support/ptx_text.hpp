// SPDX-License-Identifier: Apache-2.0
#pragma once
// PtxModule: PTX text, taken apart as far as its form can be judged without an assembler.

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace saccade::test {

/// Kernel as PTX declares it.
struct PtxEntry {
  std::string name;
  std::vector<std::size_t> parameter_bytes;
  std::size_t local_bytes{0};                      ///< stack frame of a thread
  std::size_t shared_bytes{0};                     ///< memory of a block
  unsigned threads{0};                             ///< .maxntid along x
  std::map<std::string, std::size_t> registers{};  ///< count by prefix
  std::set<std::string> labels{};
  std::set<std::string> branches{};
};

/// Module as PTX declares it, and what is wrong with its form.
struct PtxModule {
  std::string version;
  std::string target;
  std::string address_size;
  std::vector<PtxEntry> entries;
  std::vector<std::string> problems;
};

namespace ptx {

inline std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in{line};
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// Returns the number between the last brackets, 0 where there is none: "name[256]" has 256.
inline std::size_t bracketed(std::string_view text, char open) {
  const std::size_t at = text.rfind(open);
  std::size_t number{0};
  if (at != std::string_view::npos) std::from_chars(text.data() + at + 1, text.data() + text.size(), number);
  return number;
}

/// Names a use of a register that was not declared; empty where all were.
inline std::string undeclared_register(const PtxEntry& entry, const std::string& line) {
  for (std::size_t at = line.find('%'); at != std::string::npos; at = line.find('%', at + 1)) {
    std::size_t end = at + 1;
    while (end < line.size() && std::isalpha(static_cast<unsigned char>(line[end])) != 0) ++end;
    const std::string prefix = line.substr(at, end - at);
    if (end == line.size() || std::isdigit(static_cast<unsigned char>(line[end])) == 0) {
      const bool special =
          prefix == "%tid" || prefix == "%ctaid" || prefix == "%ntid" || prefix == "%SP" || prefix == "%SPL";
      if (!special) return prefix;
      continue;
    }
    std::size_t number{0};
    std::from_chars(line.data() + end, line.data() + line.size(), number);
    const auto found = entry.registers.find(prefix);
    if (found == entry.registers.end() || number >= found->second) return prefix + std::to_string(number);
  }
  return {};
}

/// Tells why a floating-point instruction may round otherwise than the host; empty where it does not.
inline std::string rounding_problem(const std::string& opcode) {
  const bool floating = opcode.find(".f32") != std::string::npos || opcode.find(".f64") != std::string::npos;
  if (!floating) return {};
  const std::string root = opcode.substr(0, opcode.find('.'));
  if (root == "fma" || root == "mad") return "fuses a product and a sum";
  if (opcode.find(".approx") != std::string::npos || opcode.find(".full") != std::string::npos) return "approximates";
  if (opcode.find(".ftz") != std::string::npos) return "flushes small numbers to zero";
  static const std::set<std::string> kRounded{"add", "sub", "mul", "div", "sqrt", "rcp"};
  if (kRounded.contains(root) && opcode.find(".rn.") == std::string::npos)
    return "leaves its rounding to the assembler";
  static const std::set<std::string> kInexact{"sin", "cos", "ex2", "lg2", "rsqrt", "tanh"};
  if (kInexact.contains(root)) return "differs from the host's function";
  return {};
}

/// Reads a statement of a kernel's body.
inline void read_statement(const std::string& line, const std::vector<std::string>& words, PtxEntry& entry,
                           std::vector<std::string>& problems) {
  const auto problem = [&](const std::string& what) { problems.push_back(entry.name + ": " + line + ": " + what); };
  if (words[0] == ".reg") {
    const std::string& name = words.back();
    const std::size_t count = bracketed(name, '<');
    entry.registers[name.substr(0, std::min(name.find('<'), name.find(';')))] = std::max<std::size_t>(count, 1);
  } else if (words[0] == ".local") {
    entry.local_bytes += bracketed(line, '[');
  } else if (words[0] == ".shared") {
    entry.shared_bytes += bracketed(line, '[');
  } else if (words[0].ends_with(':')) {
    entry.labels.insert(words[0].substr(0, words[0].size() - 1));
  } else if (words[0].front() != '{' && words[0].front() != '}') {
    const std::string& opcode = words[0].front() == '@' && words.size() > 1 ? words[1] : words[0];
    if (line.find(';') == std::string::npos) problem("no instruction");
    if (opcode.starts_with("bra")) entry.branches.insert(words.back().substr(0, words.back().find(';')));
    if (opcode.starts_with("call")) problem("calls a function");
    if (const std::string why = rounding_problem(opcode); !why.empty()) problem(why);
    if (const std::string name = undeclared_register(entry, line); !name.empty()) problem("undeclared " + name);
  }
}

inline void finish_entry(const PtxEntry& entry, std::vector<std::string>& problems) {
  for (const std::string& to : entry.branches) {
    if (!entry.labels.contains(to)) problems.push_back(entry.name + ": branches to " + to + ", which is nowhere");
  }
}

}  // namespace ptx

/// Takes PTX text apart. Form that an assembler would refuse, calls, and arithmetic that may round otherwise than the
/// host's end up in `problems`.
inline PtxModule read_ptx(std::string_view text) {
  PtxModule module;
  std::istringstream in{std::string{text}};
  PtxEntry* entry = nullptr;
  bool in_body{false};
  for (std::string line; std::getline(in, line);) {
    line = line.substr(0, line.find("//"));
    const std::vector<std::string> words = ptx::words_of(line);
    if (words.empty()) continue;
    if (words[0] == ".version" && words.size() == 2) {
      module.version = words[1];
    } else if (words[0] == ".target" && words.size() == 2) {
      module.target = words[1];
    } else if (words[0] == ".address_size" && words.size() == 2) {
      module.address_size = words[1];
    } else if (words.size() == 3 && words[0] == ".visible" && words[1] == ".entry" && !in_body) {
      entry = &module.entries.emplace_back();
      entry->name = words[2].substr(0, words[2].find('('));
    } else if (words[0] == ".extern" || words[0] == ".func" || words[0] == ".weak" || words[0] == ".global" ||
               words[0] == ".const") {
      module.problems.push_back(line + ": only kernels are expected");
    } else if (entry != nullptr && words[0] == ".param" && !in_body) {
      entry->parameter_bytes.push_back(ptx::bracketed(line, '['));
    } else if (entry != nullptr && words[0] == ".maxntid") {
      std::from_chars(words[1].data(), words[1].data() + words[1].size(), entry->threads);
    } else if (words[0] == "{" && !in_body) {
      in_body = true;
    } else if (words[0] == "}" && in_body) {
      in_body = false;
      ptx::finish_entry(*entry, module.problems);
    } else if (in_body && entry != nullptr) {
      ptx::read_statement(line, words, *entry, module.problems);
    }
  }
  if (in_body) module.problems.emplace_back("a kernel does not end");
  return module;
}

}  // namespace saccade::test
