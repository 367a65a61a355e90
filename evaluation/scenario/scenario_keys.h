// SPDX-License-Identifier: BSD-3-Clause
// Shared by the files of scenario keys: the makers of a key, by the type of its value, and the
// sections that ScenarioKeys() puts together. Internal to the schema.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "evaluation/base/words.h"
#include "evaluation/scenario/scenario_schema.h"

namespace touchdown::evaluation::schema {

using KeyList = std::vector<SchemaKey<Scenario>>;

// One section each, in the order of documentation and of a dump.
void AddDescription(KeyList& keys);
void AddPadKeys(KeyList& keys);
void AddVehicleKeys(KeyList& keys);
void AddAirKeys(KeyList& keys);
void AddSensorKeys(KeyList& keys);
void AddOwnStateKeys(KeyList& keys);
void AddTaskKeys(KeyList& keys);
void AddPlanningKeys(KeyList& keys);
void AddTrialKeys(KeyList& keys);

// Each maker takes an accessor `at`: Owner& -> member&, so that nested members need no pointers.
template <typename Owner, typename At>
SchemaKey<Owner> Number(std::string name, ValueRange range, std::string doc, At at) {
  return {
      name,
      range.unit,
      range.ToString(),
      std::move(doc),
      [=](Owner& o, const YAML::Node& n, const Where& w) { at(o) = ReadNumber(n, w, name, range); },
      [=](const Owner& o) { return WriteNumber(at(o)); }};
}

template <typename At>
SchemaKey<Scenario> Whole(std::string name, int lowest, int highest, std::string doc, At at) {
  const std::string range = std::string("[")
                                .append(std::to_string(lowest))
                                .append(", ")
                                .append(std::to_string(highest))
                                .append("], whole");
  return {name,
          "",
          range,
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) {
            at(s) = ReadWhole(n, w, name, lowest, highest);
          },
          [=](const Scenario& s) { return std::to_string(at(s)); }};
}

template <int kSize, typename Owner, typename At>
SchemaKey<Owner> Vector(std::string name, ValueRange range, std::string doc, At at) {
  return {name,
          range.unit,
          range.ToString(),
          std::move(doc),
          [=](Owner& o, const YAML::Node& n, const Where& w) {
            at(o) = ReadVector(n, w, name, kSize, range);
          },
          [=](const Owner& o) { return WriteVector(at(o)); }};
}

template <typename At>
SchemaKey<Scenario> Bool(std::string name, std::string doc, At at) {
  return {name,
          "",
          "true or false",
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) { at(s) = ReadBool(n, w, name); },
          [=](const Scenario& s) { return std::string(at(s) ? "true" : "false"); }};
}

// The words stand in the order of the enumerators.
template <typename At>
SchemaKey<Scenario> Choice(std::string name, const std::vector<std::string>& words, std::string doc,
                           At at) {
  return {name,
          "",
          Enumerate(words),
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) {
            using Enum = std::remove_reference_t<decltype(at(s))>;
            at(s) = static_cast<Enum>(ReadChoice(n, w, name, words));
          },
          [=](const Scenario& s) { return words.at(static_cast<std::size_t>(at(s))); }};
}

template <typename Owner = Scenario, typename At>
SchemaKey<Owner> Text(std::string name, std::string range, std::string doc, At at) {
  return {name,
          "",
          std::move(range),
          std::move(doc),
          [=](Owner& o, const YAML::Node& n, const Where& w) { at(o) = ReadText(n, w, name); },
          [=](const Owner& o) { return WriteText(at(o)); }};
}

/// The name of an entry of a registry, which scenario_check asks.
template <typename At>
SchemaKey<Scenario> Word(std::string name, const std::string& list, std::string doc, At at) {
  return {name,
          "",
          "as `touchdown list " + list + "` says",
          std::move(doc),
          [=](Scenario& s, const YAML::Node& n, const Where& w) { at(s) = ReadText(n, w, name); },
          [=](const Scenario& s) { return at(s); }};
}

inline ValueRange In(double lo, double hi, std::string unit) {
  return {lo, hi, false, std::move(unit)};
}
inline ValueRange Above(double lo, double hi, std::string unit) {
  return {lo, hi, true, std::move(unit)};
}

/// An accessor of a member, nested ones too.
#define TOUCHDOWN_AT(member) \
  [](auto& s) -> auto& { return s.member; }  // NOLINT(bugprone-macro-parentheses): a member's name

}  // namespace touchdown::evaluation::schema
