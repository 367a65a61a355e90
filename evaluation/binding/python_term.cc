// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/binding/python_term.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "evaluation/binding/call.h"

namespace touchdown::binding {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

namespace {

/// "term NAME: " and what follows.
std::string Of(const std::string& term, const std::string& what) {
  return std::string("term ").append(term).append(": ").append(what);
}

std::string ShapeText(const py::array& array) { return py::str(array.attr("shape")); }

std::string ShapeText(const std::vector<py::ssize_t>& shape) {
  return py::str(py::tuple(py::cast(shape)));
}

/// Copies numbers of exactly this shape; one axis of length one may be missing at the end.
void Copy(const py::handle& from, const std::vector<py::ssize_t>& shape, const std::string& term,
          const char* what, double* to) {
  const Numbers array = Numbers::ensure(from);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(Of(term, std::string(what) + " gave no array of numbers"));
  }
  std::vector<py::ssize_t> got(array.shape(), array.shape() + array.ndim());
  std::vector<py::ssize_t> shorter = shape;
  while (shorter.size() > got.size() && shorter.back() == 1) shorter.pop_back();
  if (got != shape && got != shorter) {
    throw py::value_error(Of(term, std::string(what) + " gave an array of shape " +
                                       ShapeText(array) + ", it must be " + ShapeText(shape)));
  }
  std::copy_n(array.data(), array.size(), to);
}

/// A tuple of outputs, an array or a number each, as columns.
void CopyColumns(const py::tuple& columns, py::ssize_t n, py::ssize_t m, const std::string& term,
                 double* to) {
  if (static_cast<py::ssize_t>(columns.size()) != m) {
    throw py::value_error(Of(term, "value gave " + std::to_string(columns.size()) +
                                       " outputs, and `outputs` is " + std::to_string(m)));
  }
  std::vector<double> column(static_cast<std::size_t>(n));
  for (py::ssize_t c = 0; c < m; ++c) {
    const py::object given = columns[static_cast<std::size_t>(c)];
    if (py::isinstance<py::float_>(given) || py::isinstance<py::int_>(given)) {
      std::fill(column.begin(), column.end(), given.cast<double>());
    } else {
      Copy(given, {n}, term, "value", column.data());
    }
    for (py::ssize_t i = 0; i < n; ++i) to[i * m + c] = column[static_cast<std::size_t>(i)];
  }
}

template <class T>
T Attribute(const py::object& object, const char* name, const std::string& term) {
  try {
    return object.attr(name).cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(
        Of(term, std::string(name) + " is " + std::string(py::repr(object.attr(name)))));
  }
}

std::string NameOf(const py::object& object) {
  const auto name = object.attr("name").cast<std::string>();
  if (name.empty()) throw py::value_error("a term's name is empty");
  return name;
}

solvers::TermInfo InfoOf(const py::object& object) {
  const std::string name = NameOf(object);
  return {name, Attribute<std::string>(object, "formula", name),
          Attribute<std::string>(object, "unit", name),
          Attribute<std::string>(object, "source", name), Attribute<bool>(object, "convex", name)};
}

solvers::AnyLoss LossOf(const py::object& object, const std::string& term) {
  const py::object loss = object.attr("loss")();
  const auto is = [&](auto* type) {
    return py::isinstance<std::remove_pointer_t<decltype(type)>>(loss);
  };
  if (is(static_cast<solvers::SquareLoss*>(nullptr))) return loss.cast<solvers::SquareLoss>();
  if (is(static_cast<solvers::HingeLoss*>(nullptr))) return loss.cast<solvers::HingeLoss>();
  if (is(static_cast<solvers::RangeLoss*>(nullptr))) return loss.cast<solvers::RangeLoss>();
  if (is(static_cast<solvers::LinearLoss*>(nullptr))) return loss.cast<solvers::LinearLoss>();
  throw py::type_error(Of(term, "loss() gave " + std::string(py::repr(loss)) + ", it must be a " +
                                    "SquareLoss, HingeLoss, RangeLoss or LinearLoss"));
}

/// Asks the object, with the lock of the interpreter.
class PythonMap : public solvers::BatchMap {
 public:
  PythonMap(Kept term, const solvers::BatchShape& shape, std::string name, int blocks,
            std::shared_ptr<TermTime> time)
      : term_(std::move(term)),
        shape_(shape),
        name_(std::move(name)),
        blocks_(blocks),
        time_(std::move(time)),
        windows_type_(Kept(py::module_::import("touchdown._terms").attr("Windows"))) {
    own_ = py::hasattr(term_.get(), "jacobian") ? solvers::OwnSlopes::kBlocks
                                                : solvers::OwnSlopes::kNone;
    if (Attribute<bool>(term_.get(), "jacobian_has_interval", name_)) {
      own_ = solvers::OwnSlopes::kAll;
    }
    Place();
  }

  int windows() const override { return windows_; }
  int first_block() const override { return first_; }
  solvers::OwnSlopes own_slopes() const override { return own_; }

  /// Takes the windows from the object. The lock is held.
  void Place() {
    const py::object& term = term_.get();
    first_ = Attribute<int>(term, "first_block", name_);
    const int room = std::max(0, blocks_ - shape_.window + 1 - first_);
    windows_ = term.attr("windows").is_none() ? room : Attribute<int>(term, "windows", name_);
    if (first_ < 0 || first_ > blocks_ - shape_.window + 1 || windows_ < 0 || windows_ > room) {
      throw py::value_error(Of(name_, "windows " + std::to_string(windows_) + " from first_block " +
                                          std::to_string(first_) + " on, and there is room for " +
                                          std::to_string(room)));
    }
  }

  void Value(const solvers::WindowBatch& batch, double* u) const override {
    Ask(batch, [&](const py::object& windows) {
      const py::object got = term_.get().attr("value")(windows);
      const py::ssize_t n = batch.size, m = shape_.outputs;
      if (py::isinstance<py::tuple>(got)) return CopyColumns(got, n, m, name_, u);
      Copy(got, {n, m}, name_, "value", u);
    });
  }

  void Jacobian(const solvers::WindowBatch& batch, double* u, double* du,
                double* du_dh) const override {
    Value(batch, u);
    Ask(batch, [&](const py::object& windows) {
      py::object got = term_.get().attr("jacobian")(windows);
      const py::ssize_t n = batch.size, m = shape_.outputs;
      if (own_ == solvers::OwnSlopes::kAll) {
        if (!py::isinstance<py::tuple>(got) || py::len(got) != 2) {
          throw py::type_error(Of(name_, "jacobian must give (du, du_dh)"));
        }
        const py::tuple both = got;
        Copy(both[1], {n, m}, name_, "jacobian", du_dh);
        got = both[0];
      }
      Copy(got, {n, m, shape_.window, shape_.block_size}, name_, "jacobian", du);
    });
  }

  /// Tells the object of a solve, and takes its windows from it.
  void Update(const planning::LandingContext& context) {
    pad_ = context.pad;
    WithLock([&] {
      const PadLoan loan(*this);
      term_.get().attr("update")(TermContext{context.segments, context.start, context.t0,
                                             context.interval, context.target, context.limits,
                                             context.pull_W, lent_});
      Place();
    });
  }

 private:
  /// The pad of the solve may be asked while the object is.
  class PadLoan {
   public:
    explicit PadLoan(const PythonMap& map) : map_(map) { map_.lent_->lent.Lend(map_.pad_); }
    ~PadLoan() { map_.lent_->lent.Return(); }
    PadLoan(const PadLoan&) = delete;
    PadLoan& operator=(const PadLoan&) = delete;

   private:
    const PythonMap& map_;
  };

  template <class Work>
  void Ask(const solvers::WindowBatch& batch, const Work& work) const {
    const auto begin = std::chrono::steady_clock::now();
    WithLock([&] {
      const PadLoan loan(*this);
      const py::ssize_t n = batch.size, w = shape_.window, d = shape_.block_size;
      try {
        work(windows_type_.get()(py::array_t<double>({n, w, d}, batch.q), batch.h,
                                 py::array_t<double>(n, batch.t),
                                 py::array_t<int>(n, batch.window)));
      } catch (const py::error_already_set& error) {
        const py::str first = py::str(py::array_t<double>({w, d}, batch.q));
        error.value().attr("add_note")(Of(name_, "asked for " + std::to_string(n) +
                                                     " windows, the first at q = " +
                                                     std::string(first)));
        throw;
      }
      if (!time_) return;
      ++time_->calls;
      time_->windows += batch.size;
      time_->wall_s +=
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    });
  }

  Kept term_;
  solvers::BatchShape shape_;
  std::string name_;
  int blocks_;
  std::shared_ptr<TermTime> time_;
  Kept windows_type_;
  solvers::OwnSlopes own_ = solvers::OwnSlopes::kNone;
  int windows_ = 0, first_ = 0;
  const estimation::PadPrediction* pad_ = nullptr;  // of the solve
  std::shared_ptr<Prediction> lent_ = std::make_shared<Prediction>();
};

/// The same in a landing: told of every solve, and pressed harder.
class PythonTerm : public solvers::BatchTerm, public planning::ContextUser {
 public:
  PythonTerm(solvers::TermInfo info, const solvers::BatchShape& shape, const solvers::AnyLoss& loss,
             std::shared_ptr<PythonMap> map)
      : BatchTerm(std::move(info), shape, loss, map), loss_(loss), map_(std::move(map)) {}

  void Update(const planning::LandingContext& context) override { map_->Update(context); }
  void ScaleWeight(double factor) override {
    if (const auto* hinge = std::get_if<solvers::HingeLoss>(&loss_)) {
      set_loss(hinge->Scaled(factor));
    }
  }

 private:
  solvers::AnyLoss loss_;
  std::shared_ptr<PythonMap> map_;
};

}  // namespace

Kept::Kept(py::object object)
    : object_(new py::object(std::move(object)), [](py::object* held) {
        const py::gil_scoped_acquire acquire;
        delete held;
      }) {}

void RequireTerm(const py::object& term) {
  if (py::isinstance(term, py::module_::import("touchdown._terms").attr("Term"))) return;
  throw py::type_error(std::string(py::repr(term)) +
                       " is no instance of a class that derives from touchdown.Term");
}

std::shared_ptr<solvers::Term> MakePythonTerm(const py::object& term, int blocks, int block_size,
                                              std::shared_ptr<TermTime> time) {
  RequireTerm(term);
  const solvers::TermInfo info = InfoOf(term);
  solvers::BatchShape shape;
  shape.block_size = block_size;
  shape.window = Attribute<int>(term, "window", info.name);
  shape.outputs = Attribute<int>(term, "outputs", info.name);
  shape.uses_interval = Attribute<bool>(term, "uses_interval", info.name);
  shape.linear = Attribute<bool>(term, "linear", info.name);
  shape.scale = Attribute<double>(term, "scale", info.name);
  shape.max_windows = std::max(0, blocks - shape.window + 1);
  if (shape.window < 1 || shape.window > solvers::kMaxWindow || shape.window > blocks) {
    throw py::value_error(Of(info.name, "window is " + std::to_string(shape.window) +
                                            ", it must be 1 to " +
                                            std::to_string(std::min(solvers::kMaxWindow, blocks))));
  }
  const solvers::AnyLoss loss = LossOf(term, info.name);
  auto map = std::make_shared<PythonMap>(Kept(term), shape, info.name, blocks, std::move(time));
  return std::make_shared<PythonTerm>(info, shape, loss, std::move(map));
}

std::string WhatIsWrong(const py::object& type, const std::string& term,
                        const std::string& complaint,
                        const std::vector<planning::TermCheckRow>& rows) {
  const bool own_slopes = py::hasattr(type, "jacobian");
  const auto worst = std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.errors.worst() < b.errors.worst();
  });
  std::ostringstream text;
  text << "term " << term << ": " << complaint;
  if (!(worst->errors.worst() <= planning::kTermCheckTolerance)) {
    text << "; at worst, with "
         << (worst->arrival == planning::ArrivalMode::kFree ? "free" : "fixed")
         << " arrival, relative errors are " << worst->errors.gradient << " of the gradient, "
         << worst->errors.hessian << " of the Hessian, " << worst->errors.residual_jacobian
         << " of residuals, " << worst->errors.row_jacobian << " of rows";
    if (own_slopes) {
      text << py::module_::import("touchdown._terms").attr("worst_slope")(type).cast<std::string>();
    } else if (!type.is_none()) {
      text << "; without a jacobian that says: u is not smooth over its `scale`, it depends on h "
              "or t without "
              "uses_interval, or it is not linear though it says so";
    }
  }
  return text.str();
}

planning::TermEntry PythonTermEntry(const py::object& type, std::shared_ptr<TermTime> time) {
  const py::object base = py::module_::import("touchdown._terms").attr("Term");
  if (!PyType_Check(type.ptr()) || PyObject_IsSubclass(type.ptr(), base.ptr()) != 1) {
    throw py::type_error(std::string(py::repr(type)) +
                         " is no class that derives from touchdown.Term");
  }
  planning::TermEntry entry;
  entry.info = InfoOf(type);
  const std::string& name = entry.info.name;
  entry.default_weight = Attribute<double>(type, "weight", name);
  entry.can_be_hard = Attribute<bool>(type, "can_be_hard", name);
  entry.is_limit = Attribute<bool>(type, "is_limit", name);
  entry.is_clearance = Attribute<bool>(type, "is_clearance", name);
  for (const auto& [key, parameter] : type.attr("parameters").cast<py::dict>()) {
    entry.parameters.push_back({key.cast<std::string>(), parameter.attr("value").cast<double>(),
                                parameter.attr("lo").cast<double>(),
                                parameter.attr("hi").cast<double>(),
                                parameter.attr("help").cast<std::string>()});
  }
  entry.make = [type = Kept(type), time](const planning::TermSetup& setup) {
    return WithLock([&]() -> std::shared_ptr<solvers::Term> {
      py::dict settings;
      settings["weight"] = setup.weight;
      for (const planning::TermParameter& parameter : setup.parameters) {
        settings[py::str(parameter.name)] = parameter.value;
      }
      const py::object term = type.get()(**settings);
      term.attr("setup") = py::cast(setup, py::return_value_policy::copy);
      return MakePythonTerm(term, setup.control_points, 3, time);
    });
  };
  return entry;
}

}  // namespace touchdown::binding
