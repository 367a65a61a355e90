// SPDX-License-Identifier: BSD-3-Clause
#include "sim/mujoco/mjcf_source.h"

#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <tinyxml2.h>

#include "sim/base/input_file.h"

namespace touchdown::sim {
namespace {

namespace fs = std::filesystem;
using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

constexpr int kMostElements = 4000;  // in 2 s; their time grows with the square
constexpr std::size_t kMostIncluded = 16;

// Any attribute where none is named. The first row that fits counts.
constexpr struct {
  std::string_view element, attribute;
  double most;
} kMostDeclared[] = {{"texture", "width", 2048},  {"texture", "height", 6 * 2048},
                     {"size", "nstack", 1e7},     {"size", "", 1e4},
                     {"numeric", "size", 1e4},    {"user", "dim", 1e4}};

[[noreturn]] void Refuse(const XMLElement& element, const std::string& why) {
  const int line = element.GetLineNum();  // none of what was included
  throw std::invalid_argument("MJCF: <" + std::string(element.Name()) + "> " +
                              (line > 0 ? "in line " + std::to_string(line) + " " : "") + why);
}

void Parse(const std::string& text, const std::string& of, XMLDocument* document) {
  document->Parse(text.data(), text.size());
  if (document->Error() || document->RootElement() == nullptr) {
    throw std::invalid_argument("MJCF: " + of + "it is no XML (" +
                                (document->Error() ? document->ErrorStr() : "no element") + ")");
  }
}

/// Asks each element for what it declares, and notes which files are named.
class Census {
 public:
  void Count(const XMLElement& element) {
    if (++elements_ > kMostElements) {
      Refuse(element, "is one too many: allowed are " + std::to_string(kMostElements) + " elements");
    }
    const std::string_view name = element.Name();
    if (name == "composite" || name == "hfield") Refuse(element, "is nothing that a vehicle has");
    for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string_view attribute = a->Name();
      CheckDeclared(element, *a);
      if (attribute.starts_with("file") && *a->Value() != '\0') files_.push_back({&element, a->Value()});
      if (attribute == "meshdir") folders_.insert(a->Value());
    }
    for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
      Count(*child);
    }
  }

  void RefuseFiles() const {
    if (files_.empty()) return;
    Refuse(*files_.front().element, "names a file: a vehicle's own text must stand alone");
  }

  /// Wherever MuJoCo may look for one: below the model's folder or that of the meshes, with its path or without.
  void CheckFiles(const fs::path& folder) const {
    std::size_t left = kMostInputBytes;
    for (const File& file : files_) {
      for (const fs::path& name : {fs::path(file.name), fs::path(file.name).filename()}) {
        for (const std::string& below : folders_) {
          const fs::path path = folder / below / name;
          std::error_code none;
          if (fs::exists(path, none)) left -= ReadInputFile(path.string(), left).size();
        }
      }
    }
  }

 private:
  struct File {
    const XMLElement* element;
    std::string name;
  };

  static void CheckDeclared(const XMLElement& element, const tinyxml2::XMLAttribute& attribute) {
    for (const auto& declared : kMostDeclared) {
      const bool named = declared.attribute.empty() || declared.attribute == attribute.Name();
      if (declared.element != element.Name() || !named) continue;
      if (!(std::strtod(attribute.Value(), nullptr) <= declared.most)) {
        Refuse(element, std::string("has ") + attribute.Name() + " " + attribute.Value() +
                            ": allowed is at most " +
                            std::to_string(static_cast<int>(declared.most)));
      }
      return;
    }
  }

  int elements_ = 0;
  std::vector<File> files_;
  std::set<std::string> folders_ = {""};
};

/// One text out of a file and those that it includes.
class Source {
 public:
  explicit Source(const std::string& path) : folder_(fs::path(path).parent_path()) {
    text_ = ReadInputFile(path, kMostMjcfBytes);
    if (text_.empty()) RefuseFile(path, "it is empty");
    left_ = kMostMjcfBytes - text_.size();
    Parse(text_, "", &document_);
    PutInPlace(document_.RootElement());
    Census census;
    census.Count(*document_.RootElement());
    census.CheckFiles(folder_);
  }

  /// The file's own where nothing is changed: MuJoCo then names the right lines.
  std::string Text() const {
    if (!changed_) return text_;
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return printer.CStr();
  }

 private:
  void PutInPlace(XMLElement* parent) {
    for (XMLElement *child = parent->FirstChildElement(), *next = nullptr; child; child = next) {
      next = child->NextSiblingElement();
      const std::string_view name = child->Name();
      if (child->Attribute("texture") != nullptr) {
        child->DeleteAttribute("texture");
        changed_ = true;
      }
      if (name == "include") {
        Include(*child);
        next = child->NextSiblingElement();  // what was included comes first
      } else {
        PutInPlace(child);
      }
      if (name == "include" || name == "texture" || name == "skin") {
        parent->DeleteChild(child);
        changed_ = true;
      }
    }
  }

  /// The children of the other file's root, after `element`.
  void Include(XMLElement& element) {
    const char* file = element.Attribute("file");
    if (file == nullptr) Refuse(element, "names no file");
    const std::string path = (folder_ / file).string();
    if (!included_.insert(path).second) Refuse(element, "includes " + path + " again");
    if (included_.size() > kMostIncluded) {
      Refuse(element, "is one too many: allowed are " + std::to_string(kMostIncluded));
    }
    const std::string text = ReadInputFile(path, left_);
    left_ -= text.size();
    XMLDocument other;
    Parse(text, path + ": ", &other);
    tinyxml2::XMLNode* last = &element;
    for (auto* node = other.RootElement()->FirstChild(); node; node = node->NextSibling()) {
      last = element.Parent()->InsertAfterChild(last, node->DeepClone(&document_));
    }
  }

  fs::path folder_;
  std::string text_;
  std::size_t left_ = 0;  // of the bytes
  std::set<std::string> included_;
  XMLDocument document_;
  bool changed_ = false;
};

}  // namespace

void CheckMjcf(const std::string& mjcf) {
  XMLDocument document;
  Parse(mjcf, "", &document);
  Census census;
  census.Count(*document.RootElement());
  census.RefuseFiles();
}

std::string ReadMjcf(const std::string& path) { return Source(path).Text(); }

}  // namespace touchdown::sim
