#!/bin/sh
# SPDX-License-Identifier: MIT
# bench_input.sh PROGRAM [READER]: sphgrad-bench --input takes particles as other programs write them, runs files of
# two dimensions in two, and says what is wrong with what it cannot take.
# With a READER, which reads many files in one process, for builds that are slow to start: it reads what only
# differs in how it is written, or, where the PROGRAM is -, everything; and nothing but its faults counts.
program=$1 reader=$2
at_least= # left to the reader even where the program is asked
[ "$program" != - ] || at_least=$reader
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
status=0

# particles NAMES ROW [DIMENSION [FORMAT]]: the line of names, if any, and a block of 5 x 5 x 5 or 6 x 6
# particles, each a tenth from the next; in ROW stand X, Y, Z for positions, N for the number of the row.
particles() {
    [ -z "$1" ] || printf '%b\n' "$1"
    awk -v row="$2" -v dimension="${3:-3}" -v format="${4:-%g}" 'BEGIN {
        side = dimension == 3 ? 5 : 6
        for (i = 0; i < side; i++) for (j = 0; j < side; j++) for (k = 0; k < (dimension == 3 ? side : 1); k++) {
            line = row
            gsub(/N/, n++, line)
            gsub(/X/, sprintf(format, i / 10), line)
            gsub(/Y/, sprintf(format, j / 10), line)
            gsub(/Z/, sprintf(format, k / 10), line)
            print line
        }
    }'
}

complain() {
    echo "$name: $*" >&2
    sed 's/^/    /' "$work/output" >&2
    status=1
}

# run NAME OPTION...: false where the file is left to the reader.
run() {
    name=$1
    shift
    if [ -n "$left_to_reader" ]; then
        files=$((files + 1))
        cp -r "$work/file" "$work/files/$files"
        return 1
    fi
    "$program" --input "$work/file" --support 0.25 --repetitions 1 --threads 1 "$@" >"$work/output" 2>&1
    code=$?
}
files=0
left_to_reader=$reader
mkdir "$work/files"

# takes NAME PATTERN... -- OPTION...: all particles, all of full rank, exact, and lines that match.
takes() {
    patterns=
    name=$1
    shift
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        patterns="$patterns$1
"
        shift
    done
    [ $# -eq 0 ] || shift
    run "$name" "$@" || return 0
    [ "$code" -eq 0 ] || complain "exit status $code"
    grep -qE "^particles +(125|36) of " "$work/output" || complain "not all particles"
    grep -q "all of rank [23]$" "$work/output" || complain "not all of full rank"
    awk '/^  error of/ { for (k = 5; k <= NF; k++) if (!($k < 1e-5)) bad = 1; seen++ }
        END { exit bad || seen != 2 }' "$work/output" || complain "not exact"
    printf '%s' "$patterns" >"$work/patterns"
    while read -r pattern; do
        grep -qE "$pattern" "$work/output" || complain "no line matches '$pattern'"
    done <"$work/patterns"
}

# refuses NAME PATTERN [OPTION...]: one line, exit status 2.
refuses() {
    pattern=$2
    name=$1
    shift 2
    run "$name" "$@" || return 0
    [ "$code" -eq 2 ] || complain "exit status $code instead of 2"
    [ "$(wc -l <"$work/output")" -eq 1 ] || complain "not one line"
    grep -qE "$pattern" "$work/output" || complain "does not match '$pattern'"
}

# names NAMES FORMAT COLUMNS: such names are understood; COLUMNS are those that are read.
names() {
    particles "$1" "$2" >"$work/file"
    takes "names $1" "^ +columns $3$"
}

# ---- Separators -------------------------------------------------------------------------------------------

particles 'x,y,z' 'X,Y,Z' >"$work/file"
takes commas
particles 'x;y;z' 'X;Y;Z' >"$work/file"
takes semicolons
particles 'x\ty\tz' 'X\tY\tZ' >"$work/file"
takes tabs
particles '  x   y z' ' X   Y Z' >"$work/file"
takes blanks
particles 'x|y|z' 'X|Y|Z' >"$work/file"
takes bars
particles 'x, y, z' 'X, Y,\tZ' >"$work/file"
takes 'commas and blanks'
particles 'x;y;z' 'X;Y;Z' 3 %.3f | tr . , >"$work/file"
takes 'decimal commas, semicolons'
particles '# x  y  z' 'X\tY\tZ' 3 %.3f | tr . , >"$work/file"
takes 'decimal commas, tabs'
particles '' 'X;Y;Z' 3 %.3f | tr . , >"$work/file"
takes 'decimal commas, no names'
particles '# x y z' 'X,Y,Z' >"$work/file"
takes 'names and numbers with other separators'
particles 'x,y,z,density,' 'X,Y,Z,1000,' >"$work/file"
takes 'a comma at the end' '1 / sum W .densities want --mass.'
particles 'x,y,z' 'X,Y,Z,,' >"$work/file"
takes 'commas at the end of rows alone'

# ---- Names ------------------------------------------------------------------------------------------------

names '"Id","Points:0","Points:1","Points:2","Mk"' 'N,X,Y,Z,1' 'Points:0, Points:1, Points:2'
names 'Points_0,Points_1,Points_2,Points_Magnitude' 'X,Y,Z,7' 'Points_0, Points_1, Points_2'
names 'Pos.x [m];Pos.y [m];Pos.z [m];Press [Pa];' 'X;Y;Z;1;' 'Pos.x \[m\], Pos.y \[m\], Pos.z \[m\]'
names 'position:0 position:1 position:2' 'X Y Z' 'position:0, position:1, position:2'
names 'P[x],P[y],P[z],v[x],v[y],v[z]' 'X,Y,Z,1,2,3' 'P\[x\], P\[y\], P\[z\], v\[x\], v\[y\], v\[z\]'
names 'X (m),Y (m),Z (m)' 'X,Y,Z' 'X \(m\), Y \(m\), Z \(m\)'
names 'x [m] y [m] z [m] p [Pa]' 'X Y Z 5' 'x \[m\], y \[m\], z \[m\]'
names 'x1,x2,x3' 'X,Y,Z' 'x1, x2, x3'
names 'posX,posY,posZ,velX,velY,velZ' 'X,Y,Z,0,0,1' 'posX, posY, posZ, velX, velY, velZ'
names '#1:x 2:y 3:z 4:u 5:v 6:w' 'X Y Z 0 0 1' '1:x, 2:y, 3:z, 4:u, 5:v, 6:w'
names '# [1]=x [2]=y [3]=z' 'X Y Z' '\[1\]=x, \[2\]=y, \[3\]=z'
names '# [01  x]  [02  y]  [03  z]  [04 mass]' 'X Y Z 1' '\[01  x\], \[02  y\], \[03  z\]'
names 'particle_position_x,particle_position_y,particle_position_z' 'X,Y,Z' 'particle_.*_y, particle_position_z'
names 'Coordinates_0,Coordinates_1,Coordinates_2,u' 'X,Y,Z,4' 'Coordinates_0, Coordinates_1, Coordinates_2'
names 'x-coordinate,y-coordinate,z-coordinate,x-velocity,y-velocity,z-velocity' 'X,Y,Z,0,0,1' \
    'x-coordinate, y.*, z.*, x-velocity, y.*, z-velocity'
names 'VARIABLES = "X", "Y", "Z"\nZONE T="a zone"' 'X Y Z' 'X, Y, Z'
names 'x,y,z\n[m],[m],[m]' 'X,Y,Z' 'x, y, z'
names 'Dichte [kg/m\0263],x,y,z' '1,X,Y,Z' 'x, y, z'
names 'px,py,pz,x,y,z' '1,2,3,X,Y,Z' 'x, y, z'
names '"x" "y" "z"' '"N" X Y Z' 'x, y, z'
names 'x,y,z' '"X","Y","Z"' 'x, y, z'
{
    printf 'x,y,z'
    awk 'BEGIN { for (k = 0; k < 3000; k++) printf ",q%d", k; print "" }'
    particles '' 'X,Y,Z' | awk '{ printf "%s", $0; for (k = 0; k < 3000; k++) printf ",%d", k; print "" }'
} >"$work/file"
takes 'thousands of columns' '^ +columns x, y, z$'

# ---- What they hold ---------------------------------------------------------------------------------------
left_to_reader=$at_least

particles 'x,y,z,rho,m' 'X,Y,Z,1000,1' >"$work/file"
takes 'density and mass' 'columns x, y, z, rho, m$' 'volume mass / density'
takes 'density and --mass' 'columns x, y, z, rho$' 'volume --mass / density' -- --mass 2
particles 'x,y,z,Rhop [kg/m^3],Mass' 'X,Y,Z,1000,1' >"$work/file"
takes 'density and mass in other words' 'volume mass / density'
particles 'x,y,z,volume,rho,mass' 'X,Y,Z,1e-3,nan,text' >"$work/file"
takes 'a volume, and what is not needed beside it' 'volume as given'
refuses '--mass beside volumes' '^sphgrad-bench: --mass: .* has volumes$' --mass 1
particles 'x,y,z,vx,vy,vz' 'X,Y,Z,0,0,1' >"$work/file"
takes velocities "timed field: the file's velocities"
particles 'x,y,z,vx,vy' 'X,Y,Z,0,0' >"$work/file"
takes 'velocities that are not complete' 'timed field: v = \(-y, x, 2z\)'
particles 'x,y,z,name,t' 'X,Y,Z,water,nan' >"$work/file"
takes 'words and NaN that nobody needs'
particles 'x,y,z,name' 'X,Y,Z,"water, salt"' >"$work/file"
takes 'a comma in a quoted cell'
particles 'x,y,z,"a ""name"", or two"' 'X,Y,Z,"say ""a, b"""' >"$work/file"
takes 'quotes in a quoted cell'
particles 'x,y,z,name' 'X,Y,Z,""' >"$work/file"
takes 'nothing in a quoted cell'

# ---- Lines ------------------------------------------------------------------------------------------------
left_to_reader=$reader

{
    printf 'Part;Time [s];Np\n0;0.5;125\n\n'
    particles 'Pos.x [m];Pos.y [m];Pos.z [m];Idp;' 'X;Y;Z;N;'
} >"$work/file"
takes 'lines before the names'
particles 'sep=;\nx;y;z' 'X;Y;Z' >"$work/file"
takes "Excel's line"
particles '# made by a program\n# t = 0.5\n# x y z' 'X Y Z' >"$work/file"
takes 'names in the last of some comments'
particles '# x, y, z' 'X,Y,Z' 3 %.18e >"$work/file"
takes "NumPy's names in a comment"
particles ',x,y,z' 'N,X,Y,Z' >"$work/file"
takes "pandas' index"
particles '' 'X Y Z' >"$work/file"
takes 'no names'
particles '# positions of a block' 'X Y Z' >"$work/file"
takes 'no names below a comment'
particles 'x,y,z' 'X,Y,Z' | awk '{ print } NR % 9 == 0 { print "# a comment\n\n  // another" }' >"$work/file"
takes 'comments and blank lines between rows'
particles '\0357\0273\0277x,y,z' 'X,Y,Z\r' >"$work/file"
takes 'a byte order mark, lines of Windows'
particles 'x,y,z' 'X,Y,Z' | tr '\n' '\r' >"$work/file"
takes 'lines of the old Macintosh'
particles 'x,y,z' 'X,Y,Z' 3 %.9e | tr e D >"$work/file"
takes "Fortran's exponents"
particles 'x y z q' 'X Y Z 1.5-104' >"$work/file"
takes "Fortran's exponents of three digits"
for order in UTF-16 UTF-16LE UTF-16BE; do
    if particles 'x,y,z' 'X,Y,Z' | iconv -f ASCII -t "$order" >"$work/file" 2>/dev/null; then
        takes "$order"
    else
        echo "no iconv: $order is not tried"
    fi
done
{ printf '\377\376' && particles 'x,y,z' 'X,Y,Z' | iconv -f ASCII -t UTF-16LE; } >"$work/file"
takes 'UTF-16 with a mark'
{
    printf 'ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n125\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n'
    particles 'ITEM: ATOMS id type x y z c_rho' 'N 1 X Y Z 7'
    printf 'ITEM: TIMESTEP\n1\nITEM: NUMBER OF ATOMS\n1\n'
} >"$work/file"
takes 'a dump of LAMMPS' 'columns x, y, z$' '^ +the first of several frames'
{
    printf '125\nframe 0\n'
    particles '' 'W X Y Z'
    printf '125\nframe 1\n'
} >"$work/file"
takes XYZ '^ +the first of several frames'
# Extended XYZ says in its second line what stands where.
extended() {
    printf '125\nLattice="1 0 0 0 1 0 0 0 1" %s pbc="F F F"\n' "$1"
    particles '' "$2" | sed '/^$/d'
}
extended Properties=species:S:1:pos:R:3:velo:R:3 'W X Y Z 9 9 9' >"$work/file"
takes 'extended XYZ'
[ -z "$reader" ] && grep -q 'several frames' "$work/output" && complain 'one frame is called several'
extended 'Properties=species:S:1:velo:R:3:pos:R:3:id:I:1' 'W 9 8 7 X Y Z 5' >"$work/file"
takes 'extended XYZ, velocities first'
extended 'properties="pos:R:3:species:S:1"' 'X Y Z W' >"$work/file"
takes 'extended XYZ, positions first'

# ---- Two dimensions ---------------------------------------------------------------------------------------
left_to_reader=$at_least

particles 'x,y' 'X,Y' 2 >"$work/file"
takes 'no z' '2D: the file has no z' 'v = \(-y, x\)' 'all of rank 2$'
particles '' 'X;Y' 2 | tr . , >"$work/file"
takes 'two columns without names' 'all of rank 2$'
particles 'x,z,vx,vz' 'X,Y,1,2' 2 >"$work/file"
takes 'no y' '2D: the file has no y' "the file's velocities"
particles 'x,y,z,vx,vy,vz' 'X,Y,Z,0,1,0' 2 >"$work/file"
takes 'z is constant' '2D: all z are 0$' "the file's velocities" 'all of rank 2$'
particles 'x,y,z,volume' 'X,0.5,Y,0.01' 2 >"$work/file"
takes 'y is constant' '2D: all y are 0.5$' 'volume as given'
takes 'y is constant, f64' '2D: all y are 0.5$' -- --precision f64

# ---- Refused, with what is wrong --------------------------------------------------------------------------
left_to_reader=$reader

particles 'a,b,c,d' 'X,Y,Z,1' >"$work/file"
refuses 'unknown names' 'no columns for the positions \(x, y, z\); found: a, b, c, d$'
particles 'Radius;x [m];Rho' 'X;Y;Z' >"$work/file"
refuses 'one position' 'found: Radius, x \[m\], Rho$'
particles 'name,a' 'water,X' >"$work/file"
refuses 'unknown names and words' 'found: name, a$'
particles '' 'X Y Z 1 2' >"$work/file"
refuses 'more columns than names' 'no line of names above the numbers, and 5 columns'
particles 'x,y,z,x' 'X,Y,Z,1' >"$work/file"
refuses 'a name twice' "column 'x' appears twice"
particles 'x,y,z' 'X,Y,Z' | sed '9s/.*/1,nan,2/' >"$work/file"
refuses 'NaN' "line 9: column 'y': 'nan' is not finite$"
particles 'x,y,z' 'X,Y,Z' | sed '9s/.*/1,,2/' >"$work/file"
refuses 'an empty cell' "line 9: column 'y' is empty$"
particles 'x,y,z' 'X,Y,Z' | sed '2s/.*/oops,0,0/' >"$work/file"
refuses 'a word in the first row' "line 2: column 'x': 'oops' is not a number$"
particles 'x,y,z' 'X,Y,Z' | sed '$s/,[^,]*$//' >"$work/file"
refuses 'a line cut off' '2 cells, but the header has 3; the file may end too early$'
particles 'x,y,z' 'X,Y,Z' 3 %.3f | sed '1!y/./,/' >"$work/file"
refuses 'decimal commas between commas' '6 cells, but the header has 3'
particles 'x,y,z,rho,m' 'X,Y,Z,0,1' >"$work/file"
refuses 'no density' 'line 2: the density is 0$'
printf 'x,y,z\n' >"$work/file"
refuses 'names alone' 'no particles in it$'
: >"$work/file"
refuses 'an empty file' 'no particles in it$'
printf '9\nframe 0\nW 0 0 0\n' >"$work/file"
extended Properties=species:S:1:velo:R:3 'W X Y Z' >"$work/file"
refuses 'extended XYZ without positions' 'extended XYZ whose Properties have no pos:R:3'
printf '9\nframe 0\nW 0 0 0\n' >"$work/file"
refuses 'XYZ with lines missing' '1 particles, but its first line says 9$'

# is BYTES NAME: named for what it is.
is() {
    printf "$1" >"$work/file"
    refuses "$2" "this is .*$2"
}
is '\211HDF\r\n\032\n\0\0\0\0' HDF5
is '# vtk DataFile Version 3.0\nparticles\nASCII\nDATASET POLYDATA\n' 'legacy VTK'
is '<?xml version="1.0"?>\n<VTKFile type="PolyData">\n' XML
is 'ply\nformat ascii 1.0\n' PLY
is '\037\213\010\0\0\0\0' gzip
is 'PK\003\004\024\0\0' zip
is '[{"x": 0, "y": 0}, {"x": 1, "y": 1}]\n' JSON
is '[\n  [0, 0, 0],\n  [1, 1, 1]\n]\n' JSON
is '\223NUMPY\001\0v\0' NumPy
is 'x,y,z\n1,2,3\n\0\001\002' binary
rm "$work/file"
mkdir "$work/file"
refuses 'a folder' 'directory'
rmdir "$work/file"

# ---- Volumes in another unit ------------------------------------------------------------------------------
left_to_reader=$at_least

suspects() {
    run "$1" --mass "$2" || return 0
    [ "$code" -eq 0 ] || complain "exit status $code"
    grep -q 'First suspect: the unit of the volumes' "$work/output"
}
particles 'x,y,z,rho' 'X,Y,Z,1000' >"$work/file"
suspects 'volumes a thousand times too small' 1e-3 || complain 'volumes are not suspected'
[ -n "$at_least" ] || { suspects 'right volumes' 1 && complain 'volumes are suspected'; }
[ -n "$at_least" ] || run 'hardly a neighbour' --mass 1 --support 0.05
[ -n "$at_least" ] || grep -q 'Hardly any particle has full rank. First suspect: --support' "$work/output" || complain 'no suspect'

if [ -n "$reader" ]; then
    "$reader" "$work"/files/* >"$work/output" 2>&1
    code=$? name=reader
    [ "$code" -eq 0 ] || complain "exit status $code"
    echo "$files files by the reader"
    [ "$files" -gt 70 ] || status=1
fi
exit $status
