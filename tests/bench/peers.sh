# Sourced by the benchmarks: install_peers PACKAGE... installs what Debian packages are missing. The product needs none of them.
install_peers() {
  local missing=() package as=()
  for package in "$@"; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  ((${#missing[@]})) || return 0
  ((EUID == 0)) || as=(sudo)
  "${as[@]}" apt-get install -y --no-install-recommends "${missing[@]}"
}
