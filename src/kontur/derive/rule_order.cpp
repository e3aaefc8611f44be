// SPDX-License-Identifier: Apache-2.0
#include "kontur/derive/rule_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kontur/base/error.h"
#include "kontur/derive/derive.h"
#include "kontur/derive/rule_words.h"

namespace kontur {
namespace {

/// Goes down the structures that rules name, and back.
class Order {
public:
    explicit Order(const std::vector<Rule>& rules) : rules_(rules), state_(rules.size(), State::unseen) {
        for (std::size_t n = 0; n < rules.size(); ++n) by_name_[rules[n].name] = n;
    }

    void visit(std::size_t n) {
        if (state_[n] == State::placed) return;
        way_.push_back(n);
        state_[n] = State::open;
        for (const NamedPlace& one : names_in(rules_[n].expression)) {
            const auto found = by_name_.find(one.name);
            if (found == by_name_.end()) continue;
            if (state_[found->second] == State::open) refuse_circle(found->second, one.place);
            visit(found->second);
        }
        way_.pop_back();
        state_[n] = State::placed;
        placed.push_back(n);
    }

    std::vector<std::size_t> placed;

private:
    enum class State { unseen, open, placed };

    [[noreturn]] void refuse_circle(std::size_t first, std::size_t place) const {
        std::string members;
        for (auto n = std::find(way_.begin(), way_.end(), first); n != way_.end(); ++n)
            members += rules_[*n].name + " needs ";
        refuse_rule(rules_[way_.back()].text, place,
                    fmt::format("rules run in a circle: {}{}; one of them has to be without", members, rules_[first].name));
    }

    const std::vector<Rule>& rules_;
    std::map<std::string, std::size_t> by_name_;
    std::vector<State> state_;
    std::vector<std::size_t> way_;
};

}  // namespace

std::vector<Rule> read_rules(std::span<const std::string> texts) {
    std::vector<Rule> rules;
    for (const std::string& text : texts) {
        Rule rule = read_rule(text);
        for (const Rule& other : rules)
            if (other.name == rule.name)
                refuse_rule(rule.text, rule.name_place,
                            fmt::format("a second rule makes '{}'; give one another name", rule.name));
        rules.push_back(std::move(rule));
    }
    return rules;
}

std::vector<std::size_t> order_of(const std::vector<Rule>& rules) {
    Order order(rules);
    for (std::size_t n = 0; n < rules.size(); ++n) order.visit(n);
    return order.placed;
}

std::vector<std::string> sources_of(std::span<const std::string> texts) {
    const std::vector<Rule> rules = read_rules(texts);
    std::vector<std::string> names;
    for (const Rule& rule : rules)
        for (const NamedPlace& one : names_in(rule.expression)) {
            const bool is_made = std::any_of(rules.begin(), rules.end(), [&](const Rule& r) { return r.name == one.name; });
            if (!is_made && std::find(names.begin(), names.end(), one.name) == names.end()) names.push_back(one.name);
        }
    return names;
}

}  // namespace kontur
