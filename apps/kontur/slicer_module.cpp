// SPDX-License-Identifier: Apache-2.0
#include "slicer_module.h"

#include <fmt/format.h>

#include <cstdio>

namespace kontur::app {
namespace {

/// 3D Slicer reads the last of these tags on stdout, at any time.
void tell(const std::string& tags) {
    std::fwrite(tags.data(), 1, tags.size(), stdout);
    std::fflush(stdout);
}

std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '<') result += "&lt;";
        else if (c == '>') result += "&gt;";
        else if (c == '&') result += "&amp;";
        else result += c;
    }
    return result;
}

}  // namespace

std::string slicer_module_description(std::string_view title, std::string_view purpose, std::string_view parameters) {
    return fmt::format(R"(<?xml version="1.0" encoding="utf-8"?>
<executable>
  <category>Segmentation</category>
  <title>{}</title>
  <description><![CDATA[{} Research software, not a medical device.]]></description>
  <version>{}</version>
  <license>Apache-2.0</license>
  <contributor>The kontur authors</contributor>
  <acknowledgements><![CDATA[After Heckel, Konrad and Peitgen, Fast and Smooth Interactive Segmentation of Medical Images Using Variational Interpolation, VCBM 2010.]]></acknowledgements>
{}</executable>
)",
                       title, purpose, KONTUR_VERSION, parameters);
}

std::string slicer_number(const SlicerNumber& n) {
    return fmt::format(R"(    <{0}>
      <name>{1}</name>
      <label>{2}</label>
      <longflag>{3}</longflag>
      <description><![CDATA[{4}]]></description>
      <default>{5}</default>
      <constraints>
        <minimum>{6}</minimum>
        <maximum>{7}</maximum>
        <step>{8}</step>
      </constraints>
    </{0}>
)",
                       n.tag, n.name, n.label, n.flag, n.description, n.value, n.least, n.most, n.step);
}

std::string slicer_threads(int threads) {
    return slicer_number({"integer", "threads", "Threads", "--threads", "0: as many as the machine has",
                          static_cast<double>(threads), 0, 256, 1});
}

std::string slicer_results(std::span<const SlicerResult> results) {
    std::string text = R"(  <parameters>
    <label>Result</label>
    <description><![CDATA[What was found]]></description>
)";
    for (const SlicerResult& result : results)
        text += fmt::format(R"(    <{0}>
      <name>{1}</name>
      <label>{2}</label>
      <channel>output</channel>
      <default>0</default>
      <description><![CDATA[{3}]]></description>
    </{0}>
)",
                            result.tag, result.name, result.label, result.description);
    return text + "  </parameters>\n";
}

SlicerRun::SlicerRun(std::string_view module) : module_(module) {
    tell(fmt::format(
        "<filter-start>\n<filter-name>{}</filter-name>\n<filter-comment>reading</filter-comment>\n</filter-start>\n",
        module_));
}

Work SlicerRun::work(int threads, const StopToken& stop) {
    return {threads, [this](std::string_view stage, double fraction) { report(stage, fraction); }, stop};
}

void SlicerRun::say(std::string_view sentence) {
    tell(fmt::format("<filter-comment>{}</filter-comment>\n{}\n", escaped(sentence), sentence));
}

void SlicerRun::end() {
    tell(
        fmt::format("<filter-progress>1</filter-progress>\n<filter-end>\n<filter-name>{}</filter-name>\n"
                    "<filter-time>{:.2f}</filter-time>\n</filter-end>\n",
                    module_, std::chrono::duration<double>(Clock::now() - start_).count()));
}

void SlicerRun::report(std::string_view stage, double fraction) {
    if (stage != stage_) {
        stage_ = stage;
        done_before_ = done_;
        tell(fmt::format("<filter-comment>{}</filter-comment>\n", escaped(stage)));
    }
    const double done = done_before_ + 0.5 * (1 - done_before_) * fraction;
    if (done < done_ + 0.005) return;
    done_ = done;
    tell(fmt::format("<filter-progress>{:.4f}</filter-progress>\n<filter-stage-progress>{:.4f}</filter-stage-progress>\n",
                     done, fraction));
}

}  // namespace kontur::app
