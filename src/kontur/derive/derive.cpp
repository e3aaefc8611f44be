// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/derive.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "kontur/base/error.h"
#include "kontur/derive/body_outline.h"
#include "kontur/derive/evaluate.h"
#include "kontur/derive/level_contours.h"
#include "kontur/derive/level_mesh.h"
#include "kontur/derive/mask_levels.h"
#include "kontur/derive/rule_order.h"
#include "kontur/derive/rule_words.h"
#include "kontur/derive/structure_levels.h"

namespace kontur {
namespace {

/// What rules can name, for a sentence.
std::string list_of(std::span<const std::string> structures, const std::vector<Rule>& rules) {
    constexpr std::size_t kMostListed = 20;
    std::vector<std::string> names(structures.begin(), structures.end());
    for (const Rule& rule : rules) names.push_back(rule.name);
    std::string list;
    for (std::size_t n = 0; n < std::min(names.size(), kMostListed); ++n) list += (n == 0 ? "" : ", ") + names[n];
    if (names.size() > kMostListed) list += fmt::format(" and {} more", names.size() - kMostListed);
    return list;
}

void check_names(const std::vector<Rule>& rules, std::span<const std::string> structures, bool has_image) {
    const auto is_structure = [&](const std::string& name) {
        return std::find(structures.begin(), structures.end(), name) != structures.end();
    };
    const auto is_made = [&](const std::string& name) {
        return std::any_of(rules.begin(), rules.end(), [&](const Rule& rule) { return rule.name == name; });
    };
    for (const Rule& rule : rules) {
        if (is_structure(rule.name))
            refuse_rule(rule.text, rule.name_place,
                        fmt::format("'{}' is there; give what the rule makes another name", rule.name));
        for (const NamedPlace& one : names_in(rule.expression))
            if (!is_structure(one.name) && !is_made(one.name))
                refuse_rule(rule.text, one.place,
                            fmt::format("there is no structure '{}'; there are {}", one.name, list_of(structures, rules)));
        if (needs_image(rule.expression) && !has_image)
            refuse_rule(rule.text, rule.expression.place, "body() looks at an image, and none is given");
    }
}

std::vector<std::string> unique_names(const Expression& expression) {
    std::vector<std::string> names;
    for (const NamedPlace& one : names_in(expression))
        if (std::find(names.begin(), names.end(), one.name) == names.end()) names.push_back(one.name);
    return names;
}

/// Looks for each outline once, whichever rules name it.
FindBody found_once(const Image& image, const Work& work) {
    const auto known = std::make_shared<std::map<std::optional<double>, std::shared_ptr<const Mask>>>();
    return [&image, &work, known](const std::optional<double>& threshold) {
        std::shared_ptr<const Mask>& body = (*known)[threshold];
        if (!body) body = std::make_shared<const Mask>(body_outline(image, threshold, work.untold()));
        return body;
    };
}

const Grid& grid_of(std::span<const NamedStructure> structures, const Image* image) {
    if (!structures.empty()) return structures.front().mask.grid;
    if (!image)
        throw Error(ErrorKind::invalid_input,
                    "there are 0 structures and no image; rules need at least 1 of either to work on");
    return image->grid;
}

}  // namespace

void check_rules(std::span<const std::string> texts, std::span<const std::string> structures, bool has_image) {
    const std::vector<Rule> rules = read_rules(texts);
    check_names(rules, structures, has_image);
    order_of(rules);
}

std::vector<DerivedStructure> derive(std::span<const std::string> texts, std::span<const NamedStructure> structures,
                                     const DeriveOptions& options, const Work& work) {
    const Image* const image = options.image;
    check_structures(structures);
    std::vector<std::string> names;
    for (const NamedStructure& one : structures) names.push_back(one.name);
    check_rules(texts, names, image != nullptr || options.body != nullptr);
    const std::vector<Rule> rules = read_rules(texts);
    const std::vector<std::size_t> order = order_of(rules);
    const Grid& grid = grid_of(structures, image);
    if (image) check_one_grid(image->grid, "the image", grid);

    RuleScene scene{work_lattice(grid)};
    const FindBody find_body = options.body || !image ? options.body : found_once(*image, work);
    scene.body = [&](const std::optional<double>& threshold) {
        return mask_levels(*find_body(threshold), scene.lattice, work.untold());
    };
    const std::vector<std::string> sources = sources_of(texts);
    for (const NamedStructure& one : structures)
        if (std::find(sources.begin(), sources.end(), one.name) != sources.end())
            scene.levels[one.name] = structure_levels(one, scene.lattice, work);
    std::vector<DerivedStructure> results(rules.size());
    for (std::size_t n = 0; n < order.size(); ++n) {
        work.report("derive", static_cast<double>(n) / static_cast<double>(order.size()));
        const Rule& rule = rules[order[n]];
        Levels& levels = scene.levels[rule.name];
        levels = evaluate(rule.expression, scene, work.untold());
        DerivedStructure& result = results[order[n]];
        result = {rule.name, rule.text, unique_names(rule.expression), mask_of(levels, scene.lattice, grid)};
        result.outlines = level_contours(levels, scene.lattice, grid);
        result.outlines.name = rule.name;
        if (options.mesh) result.mesh = level_mesh(levels, scene.lattice.grid, work.untold());
    }
    work.report("derive", 1);
    return results;
}

}  // namespace kontur
