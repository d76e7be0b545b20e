/// The tables of a database of results; docs/benchmark.md describes the columns.
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
  assembly TEXT NOT NULL, variant TEXT NOT NULL, planner TEXT NOT NULL, seed INTEGER NOT NULL,
  category TEXT NOT NULL, part TEXT NOT NULL,
  planner_hash TEXT NOT NULL, config_hash TEXT NOT NULL REFERENCES configs(hash),
  limit_path_timeout REAL NOT NULL, limit_path_steps INTEGER NOT NULL, limit_timeout REAL NOT NULL, limit_wall REAL NOT NULL,
  limit_cpu REAL NOT NULL, limit_memory_mb INTEGER NOT NULL, threads INTEGER NOT NULL, verify_max_penetration REAL NOT NULL,
  state TEXT NOT NULL DEFAULT 'waiting' CHECK (state IN ('waiting', 'running', 'done')),
  owner TEXT, owner_host TEXT, lease_until REAL,
  outcome TEXT, solved INTEGER, verified INTEGER, complete INTEGER, max_penetration REAL, verification TEXT,
  signal INTEGER, exit_status INTEGER, last_words TEXT,
  input TEXT, input_sha256 TEXT, parts INTEGER, excluded INTEGER, removed INTEGER, left_together INTEGER, steps INTEGER,
  wall_seconds REAL, cpu_seconds REAL, peak_rss_mb REAL, load_seconds REAL, prepare_seconds REAL, plan_seconds REAL,
  solve_seconds REAL, proof_seconds REAL, verify_seconds REAL,
  attempts INTEGER, memoised INTEGER, simulated_steps REAL, nodes REAL, collision_checks REAL, counts TEXT,
  host TEXT, cpu_model TEXT, version TEXT, started TEXT, ended TEXT,
  UNIQUE (assembly, variant, planner, seed));
CREATE INDEX IF NOT EXISTS trials_by_state ON trials(state);
CREATE TABLE IF NOT EXISTS plans (
  trial INTEGER PRIMARY KEY REFERENCES trials(id), codec TEXT NOT NULL, size INTEGER NOT NULL, bytes BLOB NOT NULL);
CREATE TABLE IF NOT EXISTS progress (
  trial INTEGER NOT NULL REFERENCES trials(id), seconds REAL NOT NULL, removed INTEGER NOT NULL);
CREATE INDEX IF NOT EXISTS progress_of_trial ON progress(trial);
)";

}  // namespace dismantle::bench
