source("reference.R")

p <- list(few = c(0.04, 0.01, 0.03, 0.02), one = 0.3,
          ties = c(0.02, 0.02, 0.5, 0.001, 0.5, 1, 0), 
          many = (((1:40) * 17) %% 41 / 41)^3)

for (method in list(c("Holm", "holm"), c("Bonferroni", "bonferroni"),
                    c("Benjamini-Hochberg", "BH"))) {
  procedure(method[1], sprintf("p.adjust(p, '%s')", method[2]))
  for (case in names(p)) answer(case, p = p.adjust(p[[case]], method[2]))
}
finish()
