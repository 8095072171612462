# A filter of Doxygen: puts the words of a field table before each member as a comment.
use strict;
use warnings;

local $/;
my $text = <>;
my %words;
while ($text =~ /\bfield\(\s*"(\w+)",[^"]*((?:"(?:[^"\\]|\\.)*"[,\s]*)+)\)/g) {
  my ($name, $strings) = ($1, $2);
  my ($unit, $about) = $strings =~ /^"([^"]*)",\s*(.*)$/s or next;
  $about =~ s/"\s*"|^"|"\s*$//g;
  $words{$name} = $unit ? "$about ($unit)" : $about;
}
$text =~ s{^(\h++)((?!return\b|static\b|using\b)[\w:<>,\s]+\s(\w+)(?:\s*=[^;]*|\{[^;]*\})?;)(?!\s*///)}
          {exists $words{$3} ? "$1/// $words{$3}\n$1$2" : "$1$2"}gme;
print $text;
