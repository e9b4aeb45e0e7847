// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/run_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>

#include "saccade/report/html_text.hpp"
#include "saccade/report/run_report_parts.hpp"
#include "saccade/report/run_report_style.hpp"

namespace saccade {
namespace {

/// Nothing but what is in the page may be loaded.
constexpr std::string_view kPolicy{
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"};

/// "scene tabletop-2 · strategy sphere", of what is known.
std::string setting(const RunReport& report) {
  std::string out;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) out += std::string{out.empty() ? "" : " · "} + name + ' ' + value;
  };
  add("scene", report.scene);
  add("strategy", report.strategy);
  add("robot", report.robot);
  add("noise", report.noise);
  add("seed", std::to_string(report.seed));
  return out;
}

std::string verdict(const RunReport& report) {
  const std::size_t n = report.views.size();
  std::string text = n == 0 ? "No view" : n == 1 ? "One view" : grouped(n) + " views";
  text += " after the initial scan.";
  if (report.initial.coverage && report.final.coverage) {
    text += " Coverage went from " + percent_text(*report.initial.coverage) + " to " +
            percent_text(*report.final.coverage) + '.';
  }
  if (!report.stop_reason.empty()) text += ' ' + stop_sentence(report.stop_reason);
  return "<p class=\"verdict\">" + html_escaped(text) + "</p>";
}

std::string header(const RunReport& report) {
  return "<header><h1>" + html_escaped(report.title) + "</h1><p class=\"soft\">" + html_escaped(setting(report)) +
         "</p>" + verdict(report) + "</header>\n";
}

std::string view_id(const ReportView& view) { return "view-" + std::to_string(view.index); }

std::string navigation(const RunReport& report) {
  std::string out = "<nav aria-label=\"Parts of this page\"><ul>";
  const auto entry = [&](const std::string& id, const std::string& text) {
    out += "<li><a href=\"#" + id + "\">" + text + "</a></li>";
  };
  entry("summary", "Summary");
  entry("scan", "Scan");
  for (const ReportView& view : report.views) entry(view_id(view), std::to_string(view.index));
  entry("run", "Run");
  return out + "</ul></nav>\n";
}

std::string summary(const RunReport& report) {
  return "<section id=\"summary\"><h2>Summary</h2>" + tiles_html(report) + charts_html(report) + table_html(report) +
         "</section>\n";
}

/// Heading and facts above the pictures; beside them where there is but one.
std::string view_html(const std::string& id, const std::string& title, const FactList& facts,
                      const std::vector<ReportPicture>& pictures) {
  std::string figures;
  for (const ReportPicture& picture : pictures) figures += picture_html(picture);
  std::string out = "<section id=\"" + id + "\" class=\"view" + (pictures.size() == 1 ? " single" : "") +
                    "\"><div><h2>" + title + "</h2>" + facts.html() + "</div>";
  if (!figures.empty()) out += "<div class=\"pictures\">" + figures + "</div>";
  return out + "</section>\n";
}

std::string scan_section(const RunReport& report) {
  FactList facts;
  facts.add("coverage", report.initial.coverage, percent_text);
  facts.add("unknown left", grouped(report.initial.unknown_left) + " voxels");
  facts.add("unknown near objects", report.initial.unknown_near_objects, count_text);
  for (const auto& [name, value] : report.initial.facts) facts.add(name.c_str(), value);
  return view_html("scan", "Initial scan", facts, report.initial.pictures);
}

/// The map before a view: after the view before it, or after the scan.
struct Before {
  std::optional<double> coverage;
  std::size_t unknown_left{0};
};

std::string view_section(const RunReport& report, const ReportView& view, const Before& before) {
  FactList facts;
  facts.add("gain", view.gain, [&](double gain) { return gain_text(gain) + ' ' + report.gain_unit; });
  if (view.candidates > 0) facts.add("candidates", grouped(view.candidates));
  if (view.coverage) {
    std::string text = percent_text(*view.coverage);
    if (before.coverage) text += " (" + signed_text(100.0 * (*view.coverage - *before.coverage), 1) + " points)";
    facts.add("coverage", text);
  }
  facts.add("unknown left",
            grouped(view.unknown_left) + " (" +
                signed_text(static_cast<double>(view.unknown_left) - static_cast<double>(before.unknown_left), 0) +
                ")");
  facts.add("unknown near objects", view.unknown_near_objects, count_text);
  facts.add("points at an object", view.points_at_object, [](bool yes) { return std::string{yes ? "yes" : "no"}; });
  for (const auto& [name, value] : view.facts) facts.add(name.c_str(), value);
  if (!view.phases.empty()) facts.add("time", duration_text(total_ms(view)) + phases_text(view));
  return view_html(view_id(view), "View " + std::to_string(view.index), facts, view.pictures);
}

std::string run_section(const RunReport& report) {
  std::string out = "<section id=\"run\"><h2>Run</h2>";
  FactList facts{"pairs"};
  facts.add("scene", report.scene);
  facts.add("strategy", report.strategy);
  facts.add("robot", report.robot);
  facts.add("noise", report.noise);
  facts.add("seed", std::to_string(report.seed));
  if (report.threads > 0) facts.add("threads", grouped(report.threads));
  if (report.min_gain) facts.add("gain threshold", gain_text(*report.min_gain) + ' ' + report.gain_unit);
  for (const auto& [name, value] : report.facts) facts.add(name, value);
  facts.add("Saccade", report.version);
  out += facts.html();
  if (!report.links.empty()) {
    out += "<h3>Files beside this page</h3><dl class=\"pairs\">";
    for (const ReportLink& link : report.links) {
      out += "<dt><a href=\"" + relative_href(link.name) + "\">" + html_escaped(link.name) + "</a></dt><dd>" +
             html_escaped(link.what) + "</dd>";
    }
    out += "</dl>";
  }
  return out + "</section>\n";
}

}  // namespace

std::string run_report_html(const RunReport& report) {
  std::size_t picture_bytes{0};
  const auto weigh = [&](const std::vector<ReportPicture>& pictures) {
    for (const ReportPicture& picture : pictures) picture_bytes += picture.png.size() / 3 * 4 + 512;
  };
  weigh(report.initial.pictures);
  for (const ReportView& view : report.views) weigh(view.pictures);

  std::string page;
  page.reserve(picture_bytes + (std::size_t{1} << 16U) + 2048 * report.views.size());
  page += "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\"><head><meta charset=\"utf-8\"/>";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>";
  page += "<meta http-equiv=\"Content-Security-Policy\" content=\"" + html_escaped(kPolicy) + "\"/>";
  page += "<title>" + html_escaped(report.title) + "</title>\n<style>";
  page += run_report_style();
  page += "</style></head><body>\n";
  page += header(report) + navigation(report) + "<main>\n" + summary(report) + legend_html(report);
  page += scan_section(report);
  Before before{report.initial.coverage, report.initial.unknown_left};
  for (const ReportView& view : report.views) {
    page += view_section(report, view, before);
    before = {view.coverage, view.unknown_left};
  }
  page += run_section(report) + "</main>\n<footer>Written by Saccade " + html_escaped(report.version) +
          ". <span class=\"hint\" hidden=\"hidden\">The keys ← and → step from view to view; a click shows a picture "
          "large.</span></footer>\n<script>";
  page += run_report_script();
  page += "</script></body></html>\n";
  return page;
}

}  // namespace saccade
