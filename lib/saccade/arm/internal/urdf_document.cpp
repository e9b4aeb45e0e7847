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
#include <string_view>
#include <vector>

#include "saccade/core/length_limit.hpp"

namespace saccade {
namespace {

/// Largest nesting of XML elements, and of links; the parser and this code recurse over them.
constexpr int kMostNested{500};

Error corrupt(const std::string& what, const std::string& where = "") { return {Errc::corrupt_data, what, where}; }

/// Collector of urdfdom's messages.
class Messages final : public console_bridge::OutputHandler {
 public:
  Messages() { console_bridge::useOutputHandler(this); }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/, int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) errors_.push_back(text);
  }
  /// Returns the message on the first link that urdfdom read in part, with its cause before it; empty without one.
  [[nodiscard]] std::string on_partial_link() const {
    const auto partial = [](const std::string& text) {
      return text.find("Could not parse") != std::string::npos && text.find("element for Link") != std::string::npos;
    };
    const auto found = std::find_if(errors_.begin(), errors_.end(), partial);
    if (found == errors_.end()) return {};
    return in_one_line((found == errors_.begin() ? "" : *(found - 1) + "; ") + *found);
  }
  /// Returns the first messages in one line: urdfdom begins with the cause.
  [[nodiscard]] std::string text() const {
    std::string all;
    for (std::size_t i = 0; i < std::min<std::size_t>(errors_.size(), 2); ++i) all += (i > 0 ? "; " : "") + errors_[i];
    return all.empty() ? "urdfdom does not say why" : in_one_line(all);
  }

 private:
  static std::string in_one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
  }

  std::vector<std::string> errors_;
};

Result<urdf::ModelInterfaceSharedPtr> parse_quietly(const std::string& urdf) {
  static std::mutex one_at_a_time;  // urdfdom has only one handler
  const std::lock_guard lock{one_at_a_time};
  const Messages messages;
  try {
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(urdf);
    // urdfdom keeps a link that it could read only in part, without the bodies that follow.
    if (const std::string partial = messages.on_partial_link(); model != nullptr && !partial.empty())
      return corrupt("no URDF that can be read: " + partial);
    if (model != nullptr) return model;
  } catch (const std::exception& error) {
    return corrupt(std::string{"no URDF that can be read: "} + error.what());
  }
  return corrupt("no URDF that can be read: " + messages.text());
}

/// Returns the depth of the elements, counted without a parser; skips comments.
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

/// Returns the complete joints by name.
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

/// Checks that every link has at most one joint above, and is not above itself. urdfdom never frees the links of a
/// loop, so it must not get one.
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

/// Checks that no list of numbers holds a percent sign: urdfdom uses what it cannot parse of such a list as the format
/// of its message. Recurses over the elements.
Status check_number_lists(const TiXmlElement& element) {
  for (const char* name : {"xyz", "rpy", "rgba", "size", "scale"}) {
    const char* text = element.Attribute(name);
    if (text != nullptr && std::string_view{text}.find('%') != std::string_view::npos) {
      return corrupt(std::string{"its "} + name + " holds a %, which is not part of a number",
                     "<" + element.ValueStr() + ">, line " + std::to_string(element.Row()));
    }
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    SACCADE_CHECK(check_number_lists(*child));
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
        return corrupt(std::string{attribute} + " is not a number", std::string{"joint "} + name);
      if (status == TIXML_SUCCESS) accelerations.emplace(name, value);
    }
  }
  return accelerations;
}

}  // namespace

Result<UrdfDocument> parse_urdf_document(const std::string& text) {
  // TinyXML steps over the number of bytes that a UTF-8 character's first byte announces, even beyond the end.
  constexpr std::size_t kLongestCharacter{4};
  const std::string urdf = text + std::string(kLongestCharacter, '\0');
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    return corrupt("no URDF: it is in UTF-16; save it as UTF-8");
  }
  if (text.starts_with('"') || text.starts_with('\'')) {
    return corrupt(
        "no URDF: it begins with a quotation mark, as a parameter does that was printed with its quotes; "
        "print it with yaml.safe_load, or rosparam get -p");
  }
  if (nesting_of(urdf) > kMostNested) return corrupt("no URDF: its elements are nested too deeply");
  TiXmlDocument xml;
  xml.Parse(urdf.c_str());
  if (xml.Error() || xml.RootElement() == nullptr) {
    return corrupt(std::string{"no XML: "} + (xml.Error() ? xml.ErrorDesc() : "nothing in it"),
                   xml.ErrorRow() > 0 ? "line " + std::to_string(xml.ErrorRow()) : std::string{});
  }
  if (xml.RootElement()->ValueStr() != "robot")
    return corrupt("no URDF: it begins with <" + xml.RootElement()->ValueStr() + ">, not with <robot>");
  SACCADE_CHECK(check_number_lists(*xml.RootElement()));
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
    return corrupt("its origin is not finite", where);
  if (position.cwiseAbs().maxCoeff() > kMaxLength_m)
    return corrupt("its origin is farther away than 1 km; URDFs are in metres", where);
  Pose T = Pose::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = position;
  return T;
}

}  // namespace saccade
