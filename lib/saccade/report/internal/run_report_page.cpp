// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/run_report_page.hpp"

#include "saccade/report/html_text.hpp"
#include "saccade/report/internal/run_report_style.hpp"

namespace saccade {
namespace {

/// Nothing but what is in the page may be loaded.
constexpr std::string_view kPolicy{
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'"};

/// "scene tabletop-2 · strategy sphere", of what is known.
std::string one_line(const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string out;
  for (const auto& [name, value] : settings) {
    if (!value.empty()) out += (out.empty() ? "" : " · ") + name + ' ' + value;
  }
  return out;
}

std::string header(const PageHead& head) {
  return "<header><h1>" + html_escaped(head.title) + "</h1><p class=\"soft\">" + html_escaped(one_line(head.settings)) +
         "</p><p class=\"verdict\">" + html_escaped(head.verdict) + "</p></header>\n";
}

std::string navigation(const PageHead& head) {
  std::string out = "<nav aria-label=\"Parts of this page\"><ul>";
  for (const auto& [id, text] : head.parts) out += "<li><a href=\"#" + id + "\">" + html_escaped(text) + "</a></li>";
  return out + "</ul></nav>\n";
}

}  // namespace

std::string page_html(const PageHead& head, std::string_view sections) {
  std::string page;
  page.reserve(sections.size() + (std::size_t{1} << 16U));
  page += "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\"><head><meta charset=\"utf-8\"/>";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>";
  page += "<meta http-equiv=\"Content-Security-Policy\" content=\"" + html_escaped(kPolicy) + "\"/>";
  page += "<title>" + html_escaped(head.title) + "</title>\n<style>";
  page += run_report_style();
  page += "</style></head><body>\n";
  page += header(head) + navigation(head) + "<main>\n";
  page += sections;
  page += "</main>\n<footer>Written by Saccade " + html_escaped(head.version) +
          ". <span class=\"hint\" hidden=\"hidden\">The keys ← and → step from view to view; a click shows a picture "
          "large.</span></footer>\n<script>";
  page += run_report_script();
  page += "</script></body></html>\n";
  return page;
}

std::string part_html(const std::string& id, const std::string& title, const FactList& facts,
                      const std::vector<ReportPicture>& pictures) {
  std::string figures;
  for (const ReportPicture& picture : pictures) figures += picture_html(picture);
  std::string out = "<section id=\"" + id + "\" class=\"view" + (pictures.size() == 1 ? " single" : "") +
                    "\"><div><h2>" + html_escaped(title) + "</h2>" + facts.html() + "</div>";
  if (!figures.empty()) out += "<div class=\"pictures\">" + figures + "</div>";
  return out + "</section>\n";
}

FactList view_facts(const ShownView& view, const MapFigures& before, const std::string& gain_unit) {
  FactList facts;
  facts.add("region", view.region, count_text);
  facts.add("gain", gain_of(view), [&](double gain) { return gain_text(gain) + ' ' + gain_unit; });
  if (view.record.candidates > 0) facts.add("candidates", grouped(view.record.candidates));
  if (view.record.measures.coverage) {
    std::string text = percent_text(*view.record.measures.coverage);
    if (before.coverage)
      text += " (" + signed_text(100.0 * (*view.record.measures.coverage - *before.coverage), 1) + " points)";
    facts.add("coverage", text);
  }
  facts.add("unknown left", grouped(view.record.measures.unknown_left) + " (" +
                                signed_text(static_cast<double>(view.record.measures.unknown_left) -
                                                static_cast<double>(before.unknown_left),
                                            0) +
                                ")");
  facts.add("unknown near objects", view.record.measures.unknown_near_objects, count_text);
  facts.add("points at an object", view.record.reveals_object,
            [](bool yes) { return std::string{yes ? "yes" : "no"}; });
  for (const auto& [name, value] : view.facts) facts.add(name, value);
  if (total_ms(view) > 0.0) facts.add("time", duration_text(total_ms(view)) + phases_text(view));
  return facts;
}

std::string view_id(const ShownView& view) { return "view-" + std::to_string(view.number); }

std::string links_html(const std::vector<ReportLink>& links) {
  if (links.empty()) return {};
  std::string out = "<h3>Files beside this page</h3><dl class=\"pairs\">";
  for (const ReportLink& link : links) {
    out += "<dt><a href=\"" + relative_href(link.name) + "\">" + html_escaped(link.name) + "</a></dt><dd>" +
           html_escaped(link.what) + "</dd>";
  }
  return out + "</dl>";
}

}  // namespace saccade
