# Sourced by the launcher and by tests/run: installs missing packages, configures and builds. Everything it says goes to stderr.
# Needs $root, the folder that holds CMakeLists.txt.

say() { printf 'demcal: %s\n' "$*" >&2; }

# install_packages [test | fuzz]: installs what packages.txt lists and dpkg does not have; with a word, what it lists under that word too.
install_packages() {
  local missing=() name only rest
  while read -r name only rest; do
    case "$name" in '' | '#'*) continue ;; esac
    [ -z "$only" ] || [ "$only" = "${1:-}" ] || continue
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
  done <"$root/packages.txt"
  [ ${#missing[@]} -gt 0 ] || return 0
  local get=(apt-get install -y --no-install-recommends "${missing[@]}") as=()
  if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null || ! sudo -n true 2>/dev/null && ! [ -t 0 ]; then
      say "these Debian packages are missing and only root may install them. Run this once, then start again:"
      say "  su -c 'apt-get update && ${get[*]}'"
      exit 69
    fi
    as=(sudo)
  fi
  say "installing ${#missing[@]} missing Debian packages: ${missing[*]}"
  local log
  log=$(mktemp)
  if ! { "${as[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q &&
    "${as[@]}" env DEBIAN_FRONTEND=noninteractive "${get[@]}"; } >"$log" 2>&1 </dev/null; then
    tail -n 15 "$log" >&2
    say "the installation failed (whole log: $log). Mend it, or install them by hand: ${get[*]}"
    exit 69
  fi
  rm -f "$log"
}

# build PRESET [TARGET...]: configures where needed and builds; one at a time per preset.
build() {
  local preset=$1
  shift
  mkdir -p "$root/build"
  exec 9>"$root/build/.$preset.lock"
  flock -n 9 || { say "another build of '$preset' is running; waiting for it"; flock 9; }
  local log="$root/build/.$preset.log"
  if [ ! -f "$root/build/$preset/build.ninja" ]; then
    say "configuring ($preset)"
    (cd "$root" && cmake --preset "$preset") >"$log" 2>&1 || { tail -n 30 "$log" >&2; say "configuring failed (whole log: $log)"; exit 70; }
  fi
  (cd "$root" && cmake --build --preset "$preset" ${1:+--target "$@"}) >&2 9>&- || { say "the build failed"; exit 70; }
  exec 9>&-
}
