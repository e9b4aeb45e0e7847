// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/urdf_document.hpp"

#include <console_bridge/console.h>
#include <tinyxml.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <set>
#include <vector>

namespace saccade {
namespace {

namespace fs = std::filesystem;

/// XML elements in one another, and links one behind the other; the parser and we go through them by recursion.
constexpr int kMostNested{500};

Error corrupt(const std::string& what, const std::string& where = "") { return {Errc::corrupt_data, what, where}; }

/// Keeps what urdfdom would print.
class Messages final : public console_bridge::OutputHandler {
 public:
  Messages() { console_bridge::useOutputHandler(this); }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
  }
  /// The first ones, in one line: urdfdom begins with the cause.
  [[nodiscard]] std::string text() const {
    std::string all;
    for (std::size_t i = 0; i < std::min<std::size_t>(errors_.size(), 2); ++i) all += (i > 0 ? "; " : "") + errors_[i];
    std::replace(all.begin(), all.end(), '\n', ' ');
    return all.empty() ? "urdfdom does not say why" : all;
  }

 private:
  std::vector<std::string> errors_;
};

Result<urdf::ModelInterfaceSharedPtr> parse_quietly(const std::string& urdf) {
  static std::mutex one_at_a_time;  // the handler is urdfdom's only one
  const std::lock_guard lock{one_at_a_time};
  const Messages messages;
  try {
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf);
    if (model != nullptr) return model;
  } catch (const std::exception& error) {
    return corrupt(std::string{"no URDF that can be read: "} + error.what());
  }
  return corrupt("no URDF that can be read: " + messages.text());
}

/// Depth of the elements, counted without a parser; comments are passed over.
int nesting_of(const std::string& xml) {
  int depth{0};
  int most{0};
  for (std::size_t i = xml.find('<'); i != std::string::npos; i = xml.find('<', i + 1)) {
    if (xml.compare(i, 4, "<!--") == 0) {
      i = xml.find("-->", i);
      if (i == std::string::npos) break;
      continue;
    }
    const std::size_t end = xml.find('>', i);
    const bool closes = i + 1 < xml.size() && xml[i + 1] == '/';
    const bool alone = end != std::string::npos && xml[end - 1] == '/';
    depth += closes ? -1 : alone ? 0 : 1;
    most = std::max(most, depth);
  }
  return most;
}

struct JointLinks {
  std::string parent;
  std::string child;
};

/// Joints by name, as far as they are complete.
std::map<std::string, JointLinks> joints_of(const TiXmlElement& robot) {
  const auto link_in = [](const TiXmlElement& joint, const char* role) {
    const TiXmlElement* element = joint.FirstChildElement(role);
    return element == nullptr ? nullptr : element->Attribute("link");
  };
  std::map<std::string, JointLinks> joints;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const char* name = joint->Attribute("name");
    const char* parent = link_in(*joint, "parent");
    const char* child = link_in(*joint, "child");
    if (name != nullptr && parent != nullptr && child != nullptr) joints.emplace(name, JointLinks{parent, child});
  }
  return joints;
}

/// One joint above every link at most, and no link above itself. urdfdom never frees the links of a loop, so it does
/// not get to see one.
Status check_tree(const std::map<std::string, JointLinks>& joints) {
  std::map<std::string, std::string> joint_above;
  for (const auto& [name, links] : joints) {
    const auto [known, is_new] = joint_above.emplace(links.child, name);
    if (is_new) continue;
    return corrupt(
        "has two joints above it, " + known->second + " and " + name + "; the joints must form a tree, without loops",
        "link " + links.child);
  }
  for (const auto& [link, ignored] : joint_above) {
    std::string above = link;
    std::set<std::string> seen;
    for (auto at = joint_above.find(above); at != joint_above.end(); at = joint_above.find(above)) {
      if (!seen.insert(above).second) return corrupt("is part of a loop of joints", "link " + link);
      if (seen.size() > kMostNested) return corrupt("has too many links before it", "link " + link);
      above = joints.at(at->second).parent;
    }
  }
  return {};
}

Result<std::map<std::string, double>> accelerations_of(const TiXmlElement& robot) {
  std::map<std::string, double> accelerations;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const TiXmlElement* limit = joint->FirstChildElement("limit");
    const char* name = joint->Attribute("name");
    if (limit == nullptr || name == nullptr) continue;
    for (const char* attribute : {"acceleration", "drake:acceleration"}) {
      double value{0.0};
      const int status = limit->QueryDoubleAttribute(attribute, &value);
      if (status == TIXML_WRONG_TYPE)
        return corrupt(std::string{attribute} + " is no number", std::string{"joint "} + name);
      if (status == TIXML_SUCCESS) accelerations.emplace(name, value);
    }
  }
  return accelerations;
}

bool is_package(const fs::path& folder, const std::string& name) {
  if (folder.filename() == name) return true;
  TiXmlDocument manifest;
  if (!manifest.LoadFile((folder / "package.xml").string()) || manifest.RootElement() == nullptr) return false;
  const TiXmlElement* stated = manifest.RootElement()->FirstChildElement("name");
  return stated != nullptr && stated->GetText() != nullptr && name == stated->GetText();
}

}  // namespace

Result<UrdfDocument> parse_urdf_document(const std::string& text) {
  // TinyXML steps over as many bytes as a character of UTF-8 begins to have, also beyond the end.
  constexpr std::size_t kLongestCharacter{4};
  const std::string urdf = text + std::string(kLongestCharacter, '\0');
  if (nesting_of(urdf) > kMostNested) return corrupt("no URDF: its elements are nested too deeply");
  TiXmlDocument xml;
  xml.Parse(urdf.c_str());
  if (xml.Error() || xml.RootElement() == nullptr) {
    return corrupt(std::string{"no XML: "} + (xml.Error() ? xml.ErrorDesc() : "nothing in it"),
                   "line " + std::to_string(xml.ErrorRow()));
  }
  if (xml.RootElement()->ValueStr() != "robot")
    return corrupt("no URDF: it begins with <" + xml.RootElement()->ValueStr() + ">, not with <robot>");
  UrdfDocument document;
  SACCADE_TRY(document.accelerations, accelerations_of(*xml.RootElement()));
  SACCADE_CHECK(check_tree(joints_of(*xml.RootElement())));
  SACCADE_TRY(document.model, parse_quietly(urdf));
  return document;
}

Result<Pose> pose_of(const urdf::Pose& pose, const std::string& where) {
  const urdf::Rotation& r = pose.rotation;
  const Eigen::Quaterniond rotation{r.w, r.x, r.y, r.z};
  const Eigen::Vector3d position{pose.position.x, pose.position.y, pose.position.z};
  if (!position.allFinite() || !rotation.coeffs().allFinite() || rotation.norm() < 0.5)
    return Error{Errc::invalid_argument, "its origin is not finite", where};
  Pose T = Pose::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = position;
  return T;
}

Result<fs::path> resolve_mesh(const std::string& uri, const fs::path& folder,
                              const std::map<std::string, fs::path>& packages) {
  constexpr std::string_view kPackage{"package://"};
  constexpr std::string_view kFile{"file://"};
  const auto not_there = [&uri](const std::string& why) { return Error{Errc::not_found, why, "mesh " + uri}; };
  if (!uri.starts_with(kPackage)) {
    if (!uri.starts_with(kFile) && uri.find("://") != std::string::npos)
      return Error{Errc::unsupported, "only package:// and file:// are read", "mesh " + uri};
    const fs::path path = uri.starts_with(kFile) ? fs::path{uri.substr(kFile.size())} : folder / uri;
    if (!fs::is_regular_file(path)) return not_there("there is no such file");
    return path;
  }
  const std::string rest = uri.substr(kPackage.size());
  const std::size_t slash = rest.find('/');
  if (slash == std::string::npos || slash == 0) return not_there("names no file in a package");
  const std::string package = rest.substr(0, slash);
  const fs::path inside = rest.substr(slash + 1);
  if (const auto given = packages.find(package); given != packages.end()) {
    if (fs::is_regular_file(given->second / inside)) return given->second / inside;
    return not_there("is not in " + given->second.string());
  }
  bool found{false};
  fs::path above = fs::absolute(folder.empty() ? "." : folder).lexically_normal();
  for (; above.has_relative_path(); above = above.parent_path()) {
    for (const fs::path& candidate : {above, above / package}) {
      if (!is_package(candidate, package)) continue;
      if (fs::is_regular_file(candidate / inside)) return candidate / inside;
      found = found || fs::is_directory(candidate);
    }
  }
  return not_there(found ? "its package has no such file"
                         : "there is no package " + package + " around the URDF; say where it is");
}

}  // namespace saccade
