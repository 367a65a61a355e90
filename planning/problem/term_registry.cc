// SPDX-License-Identifier: BSD-3-Clause
// The list of terms, and what a user may set of each.

#include "touchdown/planning/problem/term_registry.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace touchdown::planning {

#define TOUCHDOWN_TERM(name) TermEntry name();
#include "planning/problem/terms.def"
#undef TOUCHDOWN_TERM

TermRegistry StandardTerms() {
  return {
#define TOUCHDOWN_TERM(name) name(),
#include "planning/problem/terms.def"
#undef TOUCHDOWN_TERM
  };
}

namespace {

/// "a, b, c" of the names of a list.
template <class Named, class NameOf>
std::string Names(const std::vector<Named>& list, NameOf&& name_of) {
  std::string text;
  for (const Named& entry : list) text += (text.empty() ? "" : ", ") + name_of(entry);
  return text.empty() ? "none" : text;
}

TermParameter& FindParameter(const std::string& term, std::string_view name,
                             std::vector<TermParameter>* parameters) {
  for (TermParameter& parameter : *parameters) {
    if (parameter.name == name) return parameter;
  }
  throw std::invalid_argument("term " + term + " has no parameter " + std::string(name) +
                              "; known: weight, hard, " +
                              Names(*parameters, [](const TermParameter& p) { return p.name; }));
}

void RequireInside(const std::string& what, double value, double lo, double hi) {
  if (value >= lo && value <= hi) return;
  std::ostringstream text;
  text << what << " is " << value << ", it must be in [" << lo << ", " << hi << "]";
  throw std::invalid_argument(text.str());
}

constexpr double kHeaviest = 1e9;

}  // namespace

const char* ToString(TermZone::Shape shape) {
  if (shape == TermZone::Shape::kSphere) return "sphere";
  return shape == TermZone::Shape::kBox ? "box" : "cylinder";
}

TermParameter HingeWidth(double width, const std::string& unit) {
  return {"width", width, 1e-6, 1e3,
          "where the hinge turns from cubic to quadratic [" + unit + "]"};
}

TermParameter SoftMargin() {
  return {"margin", 0.93, 0.1, 1.0, "share of the limit from which the soft term acts"};
}

double TermSetup::Get(std::string_view name) const {
  for (const TermParameter& parameter : parameters) {
    if (parameter.name == name) return parameter.value;
  }
  throw std::invalid_argument("TermSetup: no parameter " + std::string(name));
}

void RequireDistinct(const TermRegistry& registry) {
  for (auto entry = registry.begin(); entry != registry.end(); ++entry) {
    for (auto other = registry.begin(); other != entry; ++other) {
      if (other->info.name != entry->info.name) continue;
      throw std::invalid_argument("term " + entry->info.name + " is registered twice");
    }
  }
}

const TermEntry& FindTerm(const TermRegistry& registry, std::string_view name) {
  for (const TermEntry& entry : registry) {
    if (entry.info.name == name) return entry;
  }
  throw std::invalid_argument("term " + std::string(name) + " is unknown; known: " +
                              Names(registry, [](const TermEntry& e) { return e.info.name; }));
}

TermSetup DefaultSetup(const TermEntry& entry, int control_points) {
  TermSetup setup;
  setup.control_points = control_points;
  setup.weight = entry.default_weight > 0.0 ? entry.default_weight : 1.0;
  setup.parameters = entry.parameters;
  return setup;
}

void ApplySettings(const TermEntry& entry, const TermSettings& settings, TermSetup* setup) {
  const std::string& name = entry.info.name;
  if (settings.weight) {
    RequireInside("terms." + name + ".weight", *settings.weight, 0.0, kHeaviest);
    setup->weight = *settings.weight;
  }
  if (settings.hard) {
    if (*settings.hard && !entry.can_be_hard) {
      throw std::invalid_argument("terms." + name + ".hard is true, and this term is a cost only");
    }
    setup->hard = *settings.hard;
  }
  for (const auto& [key, value] : settings.parameters) {
    TermParameter& parameter = FindParameter(name, key, &setup->parameters);
    RequireInside("terms." + name + "." + key, value, parameter.lo, parameter.hi);
    parameter.value = value;
  }
}

}  // namespace touchdown::planning
