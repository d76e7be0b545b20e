/// The tables of a database of results, a format: the columns of a trial are in dismantle/bench/trial_row.h.
#pragma once

namespace dismantle::bench {

inline constexpr const char* kTables = R"(
CREATE TABLE IF NOT EXISTS suite (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS configs (hash TEXT PRIMARY KEY, text TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS plugins (
  config_hash TEXT NOT NULL REFERENCES configs(hash), section TEXT NOT NULL, type TEXT NOT NULL, plugin TEXT NOT NULL,
  version TEXT NOT NULL, file TEXT NOT NULL, sha256 TEXT NOT NULL, PRIMARY KEY (config_hash, section));
CREATE TABLE IF NOT EXISTS trials (
  id INTEGER PRIMARY KEY,
  {}
  state TEXT NOT NULL DEFAULT 'waiting' CHECK (state IN ('waiting', 'running', 'done')),
  owner TEXT, owner_host TEXT, lease_until REAL,
  {}
  UNIQUE (assembly, variant, planner, seed), FOREIGN KEY (config_hash) REFERENCES configs(hash));
CREATE INDEX IF NOT EXISTS trials_by_state ON trials(state);
CREATE TABLE IF NOT EXISTS plans (
  trial INTEGER PRIMARY KEY REFERENCES trials(id), codec TEXT NOT NULL, size INTEGER NOT NULL, bytes BLOB NOT NULL);
CREATE TABLE IF NOT EXISTS progress (
  trial INTEGER NOT NULL REFERENCES trials(id), seconds REAL NOT NULL, removed INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS searches (
  trial INTEGER NOT NULL REFERENCES trials(id), search INTEGER NOT NULL, part TEXT NOT NULL, seconds REAL NOT NULL,
  effort REAL NOT NULL, best REAL NOT NULL);
CREATE INDEX IF NOT EXISTS searches_of_trial ON searches(trial);
CREATE TABLE IF NOT EXISTS search_nodes (
  trial INTEGER NOT NULL REFERENCES trials(id), search INTEGER NOT NULL, node INTEGER NOT NULL, parent INTEGER NOT NULL,
  effort REAL NOT NULL, x REAL NOT NULL, y REAL NOT NULL, z REAL NOT NULL, qw REAL NOT NULL, qx REAL NOT NULL,
  qy REAL NOT NULL, qz REAL NOT NULL, PRIMARY KEY (trial, search, node));
CREATE INDEX IF NOT EXISTS progress_of_trial ON progress(trial);
)";

}  // namespace dismantle::bench
