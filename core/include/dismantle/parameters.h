/// One declaration per parameter: type, unit, default, range or choices, doc. It feeds validation,
/// `dismantle plugins describe`, the generated reference and the JSON Schema for editors.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/param_value.h"
#include "dismantle/plugin_ref.h"

namespace dismantle {

/// `plugin`: one PluginChoice; `plugins`: a list of them.
enum class ParamType { boolean, integer, number, text, choice, plugin, plugins };

/// One allowed value of a parameter of type choice.
struct ParamChoice {
  std::string name;
  std::string doc;
};

/// The declaration of one parameter, for checks, descriptions and the reference.
struct ParamSpec {
  std::string name;  ///< [a-z][a-z0-9_]*
  ParamType type = ParamType::number;
  std::string unit;  ///< required for numbers and integers; "1" = dimensionless
  ParamValue fallback;
  std::optional<double> min, max;
  bool min_open = false, max_open = false;  ///< true: the bound itself is not allowed
  std::vector<ParamChoice> choices;
  std::string doc;
  PluginKind plugin_kind = PluginKind::path_planner;  ///< of `plugin` and `plugins`
  std::vector<ParamSpec> options{};  ///< `plugins`: keys that each item has beside the parameters of its own type
  bool required = false;             ///< there is no default: `fallback` is not a value
  bool may_be_empty = false;         ///< `plugins`: an empty list is a value
  bool advanced = false;             ///< for studies: in the map `advanced` of a configuration; needs no unit, no doc

  /// The problem with `value`, if any. Checks type, range and choice, but not the parameters of plugins.
  DISMANTLE_API std::optional<std::string> problem_with(const ParamValue& value) const;
  DISMANTLE_API std::string range_text() const;  ///< "[0, 1)", ">= 0", "" when unbounded
};

/// Problems of the declarations themselves (no doc, no unit, default out of range, bad or duplicate name).
DISMANTLE_API std::vector<std::string> problems_of_schema(const std::vector<ParamSpec>& specs);
/// `given` completed with the defaults. Completes the options of plugin choices, but not their parameters, which only
/// the host knows. Throws std::invalid_argument for unknown names, bad values and missing required parameters (the YAML
/// binder reports these earlier, with their locations).
DISMANTLE_API ParamSet complete(const std::vector<ParamSpec>& specs, const ParamSet& given);

/// How a number is declared: {.unit = "s", .min = 0, .doc = "..."}.
struct ParamTraits {
  std::string unit{};
  std::optional<double> min{}, max{};
  bool min_open = false, max_open = false;
  std::string doc;
};

/// The range of an advanced number: {0, 1} is closed, {1} has no upper bound, {.min = 0, .min_open = true} is "> 0".
struct ParamRange {
  std::optional<double> min{}, max{};
  bool min_open = false, max_open = false;
};

/// A value of an enumeration with its name in configurations.
template <class E>
struct EnumChoice {
  std::string name;
  E value;
  std::string doc{};
};

/// Collects the declarations of a parameter struct. Defaults are read from a default-constructed T,
/// the only place where they are written:
///   struct P { double range = 0.05; static void describe(Schema<P>& s) { s.add("range", &P::range, {...}); } };
/// `add` declares what a person sets, `advanced` what only a study of the algorithm changes. Both are in the same set
/// of values, so their names differ; in a configuration the advanced ones are keys of the map `advanced`. Plugins: a
/// member `PluginRef<PathPlanner>`, or a vector of them, or a vector of a struct with a member `PluginRef<...> plugin`
/// and a `describe` that declares the other members of each item (then the default has to be empty). A reference
/// without a default type, and an empty list, make the parameter required.
template <class T>
class Schema {
 public:
  Schema() { T::describe(*this); }

  /// Declares a parameter that a person sets. `of` is a member of T or of a base of T.
  template <class M, class Base>
  void add(std::string name, M Base::*of, ParamTraits traits) {
    M T::*const member = of;
    const T defaults{};
    ParamSpec spec;
    spec.name = name;
    spec.unit = std::move(traits.unit);
    spec.min = traits.min;
    spec.max = traits.max;
    spec.min_open = traits.min_open;
    spec.max_open = traits.max_open;
    spec.doc = std::move(traits.doc);
    if constexpr (std::is_same_v<M, bool>) {
      spec.type = ParamType::boolean;
      spec.fallback = defaults.*member;
      set<bool>(name, member);
    } else if constexpr (std::is_integral_v<M>) {
      spec.type = ParamType::integer;
      spec.fallback = static_cast<std::int64_t>(defaults.*member);
      // Values that the member cannot hold are out of range, even without a declared bound.
      if (std::is_unsigned_v<M> && !spec.min) spec.min = 0;
      if (sizeof(M) < sizeof(std::int64_t) && !spec.max) spec.max = static_cast<double>(std::numeric_limits<M>::max());
      if (sizeof(M) < sizeof(std::int64_t) && !spec.min) spec.min = static_cast<double>(std::numeric_limits<M>::min());
      set<std::int64_t>(name, member);
    } else if constexpr (std::is_floating_point_v<M>) {
      spec.type = ParamType::number;
      spec.fallback = static_cast<double>(defaults.*member);
      set<double>(name, member);
    } else if constexpr (is_plugin_ref<M>) {
      add_plugin(spec, member, defaults.*member);
    } else if constexpr (is_plugin_list<M>) {
      add_plugins(spec, member, defaults.*member);
    } else {
      static_assert(std::is_same_v<M, std::string>,
                    "parameters are bool, integer, floating point, string, an enum with choices, or plugins");
      spec.type = ParamType::text;
      spec.fallback = defaults.*member;
      set<std::string>(name, member);
    }
    specs_.push_back(std::move(spec));
  }

  template <class E, class Base>
  void add_choice(std::string name, E Base::*of, std::vector<EnumChoice<E>> choices, std::string doc) {
    E T::*const member = of;
    const T defaults{};
    ParamSpec spec;
    spec.name = name;
    spec.type = ParamType::choice;
    spec.doc = std::move(doc);
    for (const auto& c : choices) {
      spec.choices.push_back({c.name, c.doc});
      if (c.value == defaults.*member) spec.fallback = c.name;
    }
    setters_.emplace_back([name, member, choices](T& t, const ParamSet& p, const PluginMaker&) {
      for (const auto& c : choices)
        if (c.name == std::get<std::string>(p.at(name))) t.*member = c.value;
    });
    specs_.push_back(std::move(spec));
  }

  /// Declares a parameter that only studies change. The comment at the member says what it means.
  template <class M, class Base>
  requires(!std::is_enum_v<M>) void advanced(std::string name, M Base::*member, ParamRange range = {}) {
    add<M>(std::move(name), member,
           {.min = range.min, .max = range.max, .min_open = range.min_open, .max_open = range.max_open, .doc = {}});
    specs_.back().advanced = true;
  }
  /// The same for an enumeration: s.advanced("order", &P::order, {{"near", Order::near}, {"far", Order::far}}).
  template <class E, class Base>
  requires std::is_enum_v<E>
  void advanced(std::string name, E Base::*member, std::vector<EnumChoice<E>> choices) {
    add_choice<E>(std::move(name), member, std::move(choices), {});
    specs_.back().advanced = true;
  }

  const std::vector<ParamSpec>& specs() const { return specs_; }
  /// `values` must be complete (see dismantle::complete). `make` creates the plugins that they name.
  T bind(const ParamSet& values, const PluginMaker& make = {}) const {
    T t{};
    for (const auto& set : setters_) set(t, values, make);
    return t;
  }

 private:
  template <class M>
  struct ListItem {
    static constexpr bool is_plugin = false;
  };
  template <class Interface>
  struct ListItem<std::vector<PluginRef<Interface>>> {
    static constexpr bool is_plugin = true;
  };
  template <class Item>
  requires is_plugin_ref<decltype(Item::plugin)>
  struct ListItem<std::vector<Item>> {
    static constexpr bool is_plugin = true;
  };
  template <class M>
  static constexpr bool is_plugin_list = ListItem<M>::is_plugin;

  template <class Held, class M>
  void set(const std::string& name, M T::*member) {
    setters_.emplace_back([name, member](T& t, const ParamSet& p, const PluginMaker&) {
      t.*member = static_cast<M>(std::get<Held>(p.at(name)));
    });
  }

  template <class M>
  void add_plugin(ParamSpec& spec, M T::*member, const M& fallback) {
    spec.type = ParamType::plugin;
    spec.plugin_kind = M::kind;
    spec.fallback = fallback.choice();
    spec.required = fallback.type().empty();
    setters_.emplace_back([name = spec.name, member](T& t, const ParamSet& p, const PluginMaker& make) {
      t.*member = M(std::get<PluginChoice>(p.at(name)), make);
    });
  }

  template <class M>
  void add_plugins(ParamSpec& spec, M T::*member, const M& fallback) {
    using Item = typename M::value_type;
    std::vector<PluginChoice> choices;
    spec.type = ParamType::plugins;
    if constexpr (is_plugin_ref<Item>) {
      spec.plugin_kind = Item::kind;
      for (const Item& item : fallback) choices.push_back(item.choice());
      setters_.emplace_back([name = spec.name, member](T& t, const ParamSet& p, const PluginMaker& make) {
        (t.*member).clear();
        for (const PluginChoice& choice : std::get<std::vector<PluginChoice>>(p.at(name)))
          (t.*member).emplace_back(choice, make);
      });
    } else {
      using Ref = decltype(Item::plugin);
      const Schema<Item> items;
      spec.plugin_kind = Ref::kind;
      spec.options = items.specs();
      if (!fallback.empty()) throw std::logic_error("a list of plugins with options has no default: " + spec.name);
      setters_.emplace_back([name = spec.name, member, items](T& t, const ParamSet& p, const PluginMaker& make) {
        (t.*member).clear();
        for (const PluginChoice& choice : std::get<std::vector<PluginChoice>>(p.at(name))) {
          Item item = items.bind(choice.options, make);
          item.plugin = Ref(choice, make);
          (t.*member).push_back(std::move(item));
        }
      });
    }
    spec.required = choices.empty();
    spec.fallback = std::move(choices);
  }

  std::vector<ParamSpec> specs_;
  std::vector<std::function<void(T&, const ParamSet&, const PluginMaker&)>> setters_;
};

}  // namespace dismantle
