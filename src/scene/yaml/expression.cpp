// SPDX-License-Identifier: GPL-3.0-or-later
#include "krater/scene/yaml/expression.hpp"

#include <muParser.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include "krater/core/errors.hpp"
#include "scene/yaml/problems.hpp"

namespace krater {

namespace {

constexpr std::size_t kLongestExpression = 2000;

class ConstantField final : public FieldFunction {
 public:
  explicit ConstantField(const Triple& value) : value_{value} {}
  bool depends_on_time() const override { return false; }
  Triple operator()(const Triple&, const Triple&, double) const override { return value_; }

 private:
  Triple value_;
};

/// muParser takes `x = 3` for an assignment and `1, 2` for two results: neither is a field.
void refuse_statements(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const char before = i > 0 ? text[i - 1] : ' ';
    const bool twice = i + 1 < text.size() && text[i + 1] == '=';
    if (twice) {
      ++i;
    } else if (before != '<' && before != '>' && before != '!') {
      throw InputError("an expression cannot assign; compare with ==");
    }
  }
  if (text.size() > kLongestExpression) throw InputError("the expression is too long");
}

/// Sets the parser's variables and expression; throws InputError where it is none.
template <class Define>
void compile(mu::Parser& parser, const std::string& text, const std::string& known,
             const Define& define) {
  refuse_statements(text);
  try {
    define(parser);
    parser.SetExpr(text);
    for (const auto& [name, address] : parser.GetUsedVar()) {
      if (address == nullptr)
        throw InputError("unknown variable '" + name + "' (known: " + known + ")");
    }
    int results = 0;
    parser.Eval(results);
    if (results != 1)
      throw InputError(scene::quote(text) + " has " + std::to_string(results) + " values");
  } catch (const mu::Parser::exception_type& error) {
    throw InputError(scene::quote(text) +
                     " is neither a number nor an expression: " + error.GetMsg());
  }
}

class ExpressionField final : public FieldFunction {
 public:
  ExpressionField(Frame frame, const std::vector<std::string>& components) : frame_{frame} {
    for (const std::string& text : components) {
      parsers_.push_back(std::make_unique<mu::Parser>());
      compile(*parsers_.back(), text, "x, y, z, r, X, Y, Z, R, t, pi",
              [this](mu::Parser& parser) { define(parser); });
      for (const auto& used : parsers_.back()->GetUsedVar())
        depends_on_time_ = depends_on_time_ || used.first == "t";
    }
  }

  bool depends_on_time() const override { return depends_on_time_; }

  Triple operator()(const Triple& x, const Triple& X, double t) const override {
    now_ = place(x);
    start_ = place(X);
    time_ = t;
    Triple result{};
    for (std::size_t k = 0; k < parsers_.size(); ++k) result[k] = parsers_[k]->Eval();
    return result;
  }

 private:
  struct Place {
    double x = 0, y = 0, z = 0, r = 0;
  };

  Place place(const Triple& grid) const {
    const Triple space = to_space(frame_, grid);
    return {space[0], space[1], space[2], std::hypot(space[0], space[1])};
  }

  void define(mu::Parser& parser) {
    parser.DefineVar("x", &now_.x);
    parser.DefineVar("y", &now_.y);
    parser.DefineVar("z", &now_.z);
    parser.DefineVar("r", &now_.r);
    parser.DefineVar("X", &start_.x);
    parser.DefineVar("Y", &start_.y);
    parser.DefineVar("Z", &start_.z);
    parser.DefineVar("R", &start_.r);
    parser.DefineVar("t", &time_);
    parser.DefineConst("pi", std::numbers::pi);
  }

  Frame frame_;
  bool depends_on_time_ = false;
  std::vector<std::unique_ptr<mu::Parser>> parsers_;
  // What the parsers point at; set by each call.
  mutable Place now_, start_;
  mutable double time_ = 0;
};

}  // namespace

std::shared_ptr<const FieldFunction> make_constant_field(const Triple& value) {
  return std::make_shared<ConstantField>(value);
}

std::shared_ptr<const FieldFunction> make_expression_field(
    Frame frame, const std::vector<std::string>& components) {
  return std::make_shared<ExpressionField>(frame, components);
}

std::function<double(double)> make_time_function(const std::string& expression) {
  struct Compiled {
    double t = 0;
    mu::Parser parser;
  };
  const auto compiled = std::make_shared<Compiled>();
  compile(compiled->parser, expression, "t, pi", [&](mu::Parser& parser) {
    parser.DefineVar("t", &compiled->t);
    parser.DefineConst("pi", std::numbers::pi);
  });
  return [compiled](double t) {
    compiled->t = t;
    return compiled->parser.Eval();
  };
}

std::function<double(const std::vector<double>&)> make_table_function(
    const std::string& expression, const std::vector<std::string>& names) {
  struct Compiled {
    std::vector<double> values;
    mu::Parser parser;
  };
  const auto compiled = std::make_shared<Compiled>();
  compiled->values.resize(names.size());
  compiled->parser.DefineNameChars(
      "0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  compile(compiled->parser, expression, known, [&](mu::Parser& parser) {
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i].find('-') == std::string::npos) parser.DefineVar(names[i], &compiled->values[i]);
    parser.DefineConst("pi", std::numbers::pi);
  });
  return [compiled](const std::vector<double>& values) {
    compiled->values = values;
    return compiled->parser.Eval();
  };
}

}  // namespace krater
