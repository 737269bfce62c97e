source("reference.R")

p <- list(few = c(0.04, 0.01, 0.03, 0.02), one = 0.3,
          ties = c(0.02, 0.02, 0.5, 0.001, 0.5, 1, 0), 
          many = (((1:40) * 17) %% 41 / 41)^3)

procedure("Holm", "p.adjust(p, 'holm')")
for (case in names(p)) answer(case, p = p.adjust(p[[case]], "holm"))
finish()
