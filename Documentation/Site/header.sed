# What every VTK class has, and the site need not tell for each.
/^  static [A-Za-z]*\* New();$/d
/^  void PrintSelf(.*override;$/d
