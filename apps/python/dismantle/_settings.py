"""Configurations from Python: files, dicts, single keys."""
import json
import os


def _merge(into, key, value, path):
    """Sets the dotted `key` in the nested dict `into`."""
    *folders, last = key.split(".")
    for word in folders:
        into = into.setdefault(word, {})
        if not isinstance(into, dict):
            raise ValueError(f"{path}: '{word}' is given twice, as a value and as a section")
    if isinstance(value, dict):
        section = into.setdefault(last, {})
        if not isinstance(section, dict):
            raise ValueError(f"{path}: '{last}' is given twice, as a value and as a section")
        for inner, item in value.items():
            _merge(section, str(inner), item, f"{path}.{inner}")
    else:
        into[last] = value


def _plain(value):
    """numpy scalars, arrays and paths as what JSON knows."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "__fspath__"):
        return os.fspath(value)
    raise TypeError(f"a configuration cannot hold {value!r}")


def settings(config, set, **keys):
    """(file, overrides) for the compiled part: `config` is None, the path of a YAML file, or a dict with the keys of one; `set`
    a dict of dotted keys; `keys` further ones ('run_seed' for run.seed) that count when they are not None. Later ones win."""
    file, tree = "", {}
    if isinstance(config, dict):
        for key, value in config.items():
            _merge(tree, str(key), value, str(key))
    elif config is not None:
        file = os.fspath(config)
    for key, value in (set or {}).items():
        _merge(tree, key, value, key)
    for key, value in keys.items():
        if value is not None:
            _merge(tree, key.replace("_", ".", 1), value, key)
    overrides = [f"{key}={json.dumps(value, default=_plain, ensure_ascii=False, allow_nan=False)}" for key, value in tree.items()]
    return file, overrides
