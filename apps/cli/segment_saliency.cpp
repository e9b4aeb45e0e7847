// SPDX-License-Identifier: Apache-2.0
#include "segment_saliency.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>

#include "add_value.hpp"
#include "options.hpp"
#include "saccade/core/nearest_word.hpp"

namespace saccade::cli {
namespace {

struct NamedHeuristic {
  const char* name;
  SaliencyHeuristic (*make)(const SaliencyOptions&);
};

constexpr std::array<NamedHeuristic, 8> kHeuristics{
    {{"none", [](const SaliencyOptions&) { return equally_salient(); }},
     {"objectness", [](const SaliencyOptions&) { return objectness(); }},
     {"roundness", [](const SaliencyOptions&) { return roundness_alone(); }},
     {"isolation", [](const SaliencyOptions&) { return isolation_alone(); }},
     {"rough-first", [](const SaliencyOptions&) { return rough_first(); }},
     {"size", [](const SaliencyOptions& options) { return size_prior(options.size); }},
     {"height", [](const SaliencyOptions& options) { return height_above_support(options.height); }},
     {"region", [](const SaliencyOptions& options) { return inside_region(options.region.value()); }}}};

std::string known_names() { return joined(kHeuristics, ", ", &NamedHeuristic::name); }

/// "name" or "name=weight".
BlendPart parse_part(const std::string& text, const SaliencyOptions& options) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  const auto found = std::find_if(kHeuristics.begin(), kHeuristics.end(),
                                  [&](const NamedHeuristic& heuristic) { return heuristic.name == name; });
  if (found == kHeuristics.end()) {
    std::vector<std::string_view> known;
    for (const NamedHeuristic& heuristic : kHeuristics) known.emplace_back(heuristic.name);
    usage_error("--saliency",
                "there is no heuristic '" + name + "'; known: " + known_names() + did_you_mean(name, known));
  }
  if (name == "region" && !options.region) {
    usage_error("--saliency", "region needs one: give --box or --sphere");
  }
  double weight{1.0};
  if (equals != std::string::npos) weight = parse_numbers("--saliency", text.substr(equals + 1), 1)[0];
  require_positive(weight, "--saliency: the weight of " + name);
  return {name, weight, found->make(options)};
}

std::vector<BlendPart> parse_parts(const SaliencyOptions& options) {
  std::vector<BlendPart> parts;
  std::size_t begin{0};
  while (begin <= options.names.size()) {
    const std::size_t end = std::min(options.names.find(',', begin), options.names.size());
    parts.push_back(parse_part(options.names.substr(begin, end - begin), options));
    begin = end + 1;
  }
  return parts;
}

bool has_part(const std::vector<BlendPart>& parts, const char* name) {
  return std::any_of(parts.begin(), parts.end(), [&](const BlendPart& part) { return part.name == name; });
}

}  // namespace

void add_saliency_options(CLI::App& command, SaliencyOptions& options) {
  add_value(command, "--saliency", options.names, "NAME[=WEIGHT],...",
            "measure of saliency: " + known_names() + "; several with weights are blended, as size=2,height=1")
      ->each([&options](const std::string&) { options.given = true; });
  add_value(command, "--size", options.size.size_m, "METRES",
            "saliency size: longest size of what is looked for, metres");
  add_point(command, "--up", options.up,
            "direction up, for the saliency height (default: 0,0,1; 0,-1,0 with --transform) and the picture "
            "(default: guessed "
            "from the points)");
  command
      .add_option_function<std::string>(
          "--box",
          [&options](const std::string& text) {
            if (options.region) usage_error("--box", "there is a region already; give one");
            options.region = parse_box("--box", text);
          },
          "saliency region: a box, metres")
      ->type_name("X0,Y0,Z0,X1,Y1,Z1");
  command
      .add_option_function<std::string>(
          "--sphere",
          [&options](const std::string& text) {
            if (options.region) usage_error("--sphere", "there is a region already; give one");
            const std::vector<double> n = parse_numbers("--sphere", text, 4);
            require_positive(n[3], "--sphere: the radius");
            options.region = Sphere{{n[0], n[1], n[2]}, n[3]};
          },
          "saliency region: centre and radius of a sphere, metres")
      ->type_name("X,Y,Z,RADIUS");
}

std::string saliency_text(const SaliencyOptions& options) {
  std::ostringstream text;
  text.precision(17);
  text << options.names << " size " << options.size.size_m << " up " << options.height.up.transpose();
  if (options.region) {
    const Box box = bounds(*options.region);
    text << (std::holds_alternative<Sphere>(*options.region) ? " sphere " : " box ") << box.min.transpose() << ' '
         << box.max.transpose();
  }
  return text.str();
}

void check_saliency_options(SaliencyOptions& options, bool single_camera) {
  options.height.up = options.up.value_or(single_camera ? Eigen::Vector3d{0.0, -1.0, 0.0} : Eigen::Vector3d::UnitZ());
  require_ok(options.size.validate(), "--size");
  require_ok(options.height.validate(), "--up");
  std::vector<BlendPart> parts = parse_parts(options);
  if (options.region && !has_part(parts, "region")) {
    usage_error("--box, --sphere", "are for the saliency region: add --saliency region");
  }
  options.heuristic = parts.size() == 1 ? parts[0].heuristic : weighted_blend(std::move(parts));
}

}  // namespace saccade::cli
