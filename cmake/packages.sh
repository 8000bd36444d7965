# packages.sh: to be sourced by scripts. need_packages PACKAGE... (Debian and Ubuntu names) installs what is missing,
# or says what to install and exits 1.

# What the library is built from. Of OpenBLAS both, by name: the one with threads is what Debian's other libraries bring
# at run time, so that what is linked is what is loaded; the serial one is what a self-contained library carries.
plm_build_packages='g++ cmake ninja-build libopenblas-pthread-dev libopenblas-serial-dev liblapack-dev libarpack2-dev
    libfftw3-dev libsuitesparse-dev libscotch-dev libeigen3-dev'

# Tells whether a package, or the program it is wanted for, is there.
plm_has_package() {
    case $1 in
    ninja-build) command -v ninja >/dev/null && return ;;
    calculix-ccx) command -v ccx >/dev/null && return ;;
    g++ | cmake | pkg-config) command -v "$1" >/dev/null && return ;;
    esac
    dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'
}

# sudo that will not ask for a password where nobody can answer.
plm_may_use_sudo() {
    command -v sudo >/dev/null || return 1
    [ -t 0 ] || sudo -n true 2>/dev/null
}

plm_give_up() {
    echo "$1" >&2
    exit 1
}

need_packages() {
    [ -z "${PLM_PACKAGES_INSTALLED:-}" ] || return 0
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        plm_give_up "This system has no apt. Install what Debian calls
    $*
and run again with PLM_PACKAGES_INSTALLED=1 in the environment."
    fi
    plm_missing=
    for plm_package; do
        plm_has_package "$plm_package" || plm_missing="$plm_missing $plm_package"
    done
    [ -n "$plm_missing" ] || return 0

    plm_root="env DEBIAN_FRONTEND=noninteractive"
    if [ "$(id -u)" != 0 ]; then
        plm_may_use_sudo || plm_give_up "Packages are missing and this user may not install them. As root:
    apt-get update && apt-get install -y$plm_missing"
        plm_root="sudo $plm_root"
    fi
    echo "Installing:$plm_missing"
    # shellcheck disable=SC2086
    if ! $plm_root apt-get update -q || ! $plm_root apt-get install -y -q --no-install-recommends $plm_missing; then
        plm_give_up "apt-get failed. These packages are needed:
   $plm_missing"
    fi
}
